//! Lines of JSON for scripts.

use serde_json::{Number, Value};

/// A line of JSON, without its end. A number that is a 32-bit one has the fewest digits that give it back: 0.7 instead
/// of 0.699999988079071.
pub fn json_line(value: &Value) -> String {
    shortened(value).to_string()
}

fn shortened(value: &Value) -> Value {
    match value {
        Value::Number(number) => Value::Number(shortest(number)),
        Value::Array(values) => values.iter().map(shortened).collect(),
        Value::Object(fields) => {
            fields.iter().map(|(name, value)| (name.clone(), shortened(value))).collect()
        }
        Value::Null | Value::Bool(_) | Value::String(_) => value.clone(),
    }
}

fn shortest(number: &Number) -> Number {
    let shorter = || {
        let wide = number.as_f64().filter(|_| number.is_f64())?;
        let narrow = wide as f32;
        let is_narrow = f64::from(narrow) == wide;
        is_narrow.then(|| narrow.to_string().parse().ok()).flatten().and_then(Number::from_f64)
    };
    shorter().unwrap_or_else(|| number.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_32_bit_number_has_the_fewest_digits_that_give_it_back() {
        let line = json!({"a": [0.7_f32, 12.3456_f32, 1.0e-7_f32, -3.0_f32], "b": {"c": 1}});
        let text = json_line(&line);
        assert_eq!(text, r#"{"a":[0.7,12.3456,1e-7,-3.0],"b":{"c":1}}"#);
        let read: Value = serde_json::from_str(&text).expect("JSON");
        let numbers = read["a"].as_array().expect("a list").iter();
        let read: Vec<f32> = numbers.map(|of| of.as_f64().expect("a number") as f32).collect();
        assert_eq!(read, [0.7, 12.3456, 1.0e-7, -3.0]);
    }

    #[test]
    fn a_64_bit_number_and_a_whole_number_keep_all_their_digits() {
        let line = json!({"mean": 0.1_f64 + 0.2, "seed": u64::MAX, "none": f32::NAN});
        assert_eq!(
            json_line(&line),
            r#"{"mean":0.30000000000000004,"none":null,"seed":18446744073709551615}"#
        );
    }
}
