//! Declares the parameters of a learner. The documentation, the default and the range of each are in one place.

/// Declares a struct of parameters, in the order of files, with their defaults and a check of their ranges. A range may refer to other
/// parameters by `*name`. The documentation of a field ends with its range.
///
/// ```text
/// parameters! {
///     /// The parameters of a learner.
///     pub struct Learner {
///         /// Share of a miss by which a prediction moves.
///         rate: f32 = 0.2, 0.001..=1.0;
///     }
/// }
/// ```
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        pub struct $name:ident {
            $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr, $range:expr;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $(
                $(#[$field_meta])*
                #[doc = concat!("\n\nRange: `", stringify!($range), "`.")]
                pub $field: $type,
            )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default),* }
            }
        }

        impl $name {
            /// Checks every parameter.
            ///
            /// # Errors
            /// Returns the first parameter that is outside its range.
            pub fn check(&self) -> Result<(), $crate::check::Invalid> {
                let Self { $($field),* } = self;
                $($crate::check::within(stringify!($field), *$field, $range)?;)*
                Ok(())
            }
        }
    };
}

pub(crate) use parameters;

#[cfg(test)]
mod tests {
    use serde::Serialize;
    use serde::de::DeserializeOwned;
    use serde_json::Value;

    use crate::check::Invalid;
    use crate::learn::classifiers::{XcsSettings, ZcsSettings};
    use crate::learn::neat::NeatRules;
    use crate::learn::q_table::QRule;

    /// Checks that the defaults are allowed, and that each number of `usual` may have the values at both ends of the range that an error
    /// names, and no value beyond them. Returns the number of ranges.
    fn ranges_of<T>(usual: &T, check: fn(&T) -> Result<(), Invalid>) -> usize
    where
        T: Default + Serialize + DeserializeOwned,
    {
        assert_eq!(check(&T::default()), Ok(()));
        let usual = serde_json::to_value(usual).expect("written");
        let result = |field: &str, value: Value| {
            let mut changed = usual.clone();
            changed[field] = value;
            check(&serde_json::from_value(changed).expect("read"))
        };
        let mut ranges = 0;
        for (field, default) in usual.as_object().expect("fields") {
            let is_whole = default.is_u64();
            let number =
                |value: f64| if is_whole { Value::from(value as u64) } else { value.into() };
            let beyond_all = if is_whole { f64::from(u32::MAX) } else { 1.0e30 };
            if default.is_boolean() || result(field, number(beyond_all)).is_ok() {
                continue;
            }
            let refusal = result(field, number(beyond_all)).expect_err("refused");
            assert_eq!(refusal.field, *field);
            let (least, most) = refusal.allowed.split_once(" to ").expect("a range");
            let [least, most]: [f64; 2] = [least, most].map(|end| end.parse().expect("a number"));
            assert_eq!(result(field, number(least)), Ok(()), "{field}");
            assert_eq!(result(field, number(most)), Ok(()), "{field}");
            let off = |end: f64| if is_whole { 1.0 } else { end.abs().max(1.0e-3) * 1.0e-3 };
            for beyond in [least - off(least), most + off(most)] {
                let is_number = beyond >= 0.0 || !is_whole;
                assert!(!is_number || result(field, number(beyond)).is_err(), "{field} {beyond}");
            }
            ranges += 1;
        }
        ranges
    }

    #[test]
    fn every_parameter_is_refused_beyond_the_ends_of_its_range_alone() {
        assert_eq!(ranges_of(&XcsSettings::default(), XcsSettings::check), 14);
        assert_eq!(ranges_of(&ZcsSettings::default(), ZcsSettings::check), 10);
        // The limit of weights must not be below these three parameters.
        let still = NeatRules {
            weight_step: 0.0,
            new_weight: 0.0,
            first_weight: 0.0,
            ..NeatRules::default()
        };
        assert_eq!(ranges_of(&still, NeatRules::check), 26);
        assert_eq!(ranges_of(&QRule::default(), QRule::check), 4);
    }

    #[test]
    fn a_refusal_names_the_parameter_its_value_and_its_range() {
        let refusal = |rules: NeatRules| rules.check().unwrap_err().to_string();
        let rules = NeatRules { add_node: f64::NAN, ..NeatRules::default() };
        assert_eq!(refusal(rules), "add_node is NaN; allowed: 0 to 1");
        let rules = NeatRules { weight_step: 9.0, ..NeatRules::default() };
        assert_eq!(refusal(rules), "weight_step is 9; allowed: 0 to 8");
    }
}
