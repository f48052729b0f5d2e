//! Numbers in lines of JSON, which scripts read.

use serde_json::{Number, Value};

/// Converts a 32-bit number to JSON with the fewest digits that give it back: 0.7 instead of 0.699999988079071. A number that is
/// not finite becomes null.
pub fn short(value: f32) -> Value {
    let shortest = value.to_string().parse().ok().and_then(Number::from_f64);
    shortest.map_or(Value::Null, Value::Number)
}

/// Shortens all fractions of a value as `short` does. They must be 32-bit numbers, as in settings.
#[expect(clippy::cast_possible_truncation, reason = "they were 32-bit numbers")]
pub fn with_short_numbers(value: &Value) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            number.as_f64().map_or(Value::Null, |wide| short(wide as f32))
        }
        Value::Array(values) => values.iter().map(with_short_numbers).collect(),
        Value::Object(fields) => {
            fields.iter().map(|(name, value)| (name.clone(), with_short_numbers(value))).collect()
        }
        _ => value.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_32_bit_number_has_the_fewest_digits_that_give_it_back() {
        let values = [0.7_f32, 12.3456, 1.0e-7, -3.0, f32::MAX];
        let line = json!({"a": values, "b": {"seed": u64::MAX, "none": f32::NAN}});
        let text = with_short_numbers(&line).to_string();
        assert!(text.starts_with(r#"{"a":[0.7,12.3456,1e-7,-3.0,"#), "{text}");
        assert!(text.ends_with(r#""b":{"none":null,"seed":18446744073709551615}}"#), "{text}");
        let read: Value = serde_json::from_str(&text).expect("JSON");
        let numbers = read["a"].as_array().expect("a list").iter();
        let read: Vec<f32> = numbers.map(|of| of.as_f64().expect("a number") as f32).collect();
        assert_eq!(read, values);
        assert_eq!(short(f32::INFINITY), Value::Null);
    }
}
