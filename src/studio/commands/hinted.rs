//! Enumerations whose values have a name and a tooltip.

/// Declares an enum with the list `ALL` of its values, and a `name` and a `hint` for each: `pub enum Side { Left = "Left", "The left side"; }`.
/// The hint is also the documentation of the value.
macro_rules! hinted_values {
    (
        $(#[$meta:meta])*
        pub enum $hinted:ident {
            $($(#[$more:meta])* $value:ident = $name:literal, $hint:literal;)*
        }
    ) => {
        snakes_core::schema::named_values! {
            $(#[$meta])*
            pub enum $hinted {
                $(
                    #[doc = $hint]
                    $(#[$more])*
                    $value = $name;
                )*
            }
        }

        impl $hinted {
            /// Returns the tooltip of the value, without a shortcut.
            pub fn hint(self) -> &'static str {
                match self { $(Self::$value => $hint,)* }
            }
        }
    };
}

pub(in crate::studio) use hinted_values;
