//! Conversions of Python's values into texts of settings, and of the core's values into dictionaries.

use std::ops::RangeInclusive;

use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde::Serialize;

use crate::errors::{crashed, refused};

/// Returns a value in the form that `--set` takes: `5`, `0.3`, `true`, `none`, `[0.4, 0.5]`.
pub fn text_of(field: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_none() {
        return Ok("none".to_owned());
    }
    if let Ok(text) = value.cast::<PyString>() {
        return text.extract();
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(flag.is_true().to_string());
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let texts: Vec<String> =
            value.try_iter()?.map(|one| text_of(field, &one?)).collect::<PyResult<_>>()?;
        return Ok(format!("[{}]", texts.join(", ")));
    }
    if value.is_instance_of::<PyInt>() {
        return value.str()?.extract();
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(number(value.extract()?));
    }
    // NumPy's numbers and arrays can convert themselves into Python's.
    if value.hasattr("tolist")? {
        return text_of(field, &value.call_method0("tolist")?);
    }
    let kind = value.get_type().name()?;
    Err(refused(field, format!("a {kind}"), "a number, a bool, a string, None, or a list of these"))
}

/// Formats a number as settings spell it: a whole number has no point, so that 5.0 becomes 5.
fn number(value: f64) -> String {
    value.to_string()
}

/// Reads a whole number within a range. Errors name the field and the range, which errors of Python's own conversion do not.
pub fn whole(field: &str, value: &Bound<'_, PyAny>, range: RangeInclusive<u64>) -> PyResult<u64> {
    let allowed = format!("{} to {}", range.start(), range.end());
    whole_as(field, value, range, &allowed)
}

/// Reads a whole number within a range. Errors have `allowed` in place of the range's limits.
pub fn whole_as(
    field: &str,
    value: &Bound<'_, PyAny>,
    range: RangeInclusive<u64>,
    allowed: &str,
) -> PyResult<u64> {
    let Ok(number) = value.call_method0("__index__") else {
        let kind = value.get_type().name()?;
        let message = format!("{field} is a {kind}; allowed: a whole number, {allowed}");
        return Err(PyTypeError::new_err(message));
    };
    match number.extract() {
        Ok(number) if range.contains(&number) => Ok(number),
        _ => {
            // Python refuses to format numbers of thousands of digits.
            let text = number.str().map_or("too large".to_owned(), |text| text.to_string());
            Err(refused(field, text, allowed))
        }
    }
}

/// Reads a whole number of 32 bits without a sign.
pub fn whole_u32(field: &str, value: &Bound<'_, PyAny>) -> PyResult<u32> {
    Ok(whole(field, value, 0..=u32::MAX.into())? as u32)
}

/// Reads a seed, a whole number of 64 bits without a sign.
pub fn seed_of(value: &Bound<'_, PyAny>) -> PyResult<u64> {
    whole("seed", value, 0..=u64::MAX)
}

/// Returns the changed settings in a dictionary, in its order: names and texts of values. `prefix` precedes each name.
pub fn changes_in(
    field: &str,
    prefix: &str,
    settings: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<(String, String)>> {
    let Some(settings) = settings.filter(|settings| !settings.is_none()) else {
        return Ok(Vec::new());
    };
    let Ok(settings) = settings.cast::<PyDict>() else {
        let kind = settings.get_type().name()?;
        return Err(refused(field, format!("a {kind}"), "a dictionary of names and values"));
    };
    let change = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let Ok(name) = name.cast::<PyString>() else {
            return Err(refused(field, name.repr()?, "names as strings"));
        };
        let path = prefix.to_owned() + &name.extract::<String>()?;
        let text = text_of(&path, &value)?;
        Ok((path, text))
    };
    settings.iter().map(change).collect()
}

/// Returns the function of the compiled module that restores what pickle stored.
pub fn restorer<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("snakes_and_stairs._core")?.getattr(name)
}

/// Converts a value of the core into dictionaries, lists and numbers of Python. Numbers keep the digits that files have.
pub fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| crashed(error.to_string()))?;
    parsed(py, &text)
}

/// Parses a text of JSON into dictionaries, lists and numbers of Python.
pub fn parsed<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// Returns the rows of an array of points. Each row must have `columns` finite numbers.
pub fn rows(
    field: &str,
    array: &PyReadonlyArray2<'_, f64>,
    columns: usize,
) -> PyResult<Vec<Vec<f64>>> {
    let view = array.as_array();
    let (count, found) = view.dim();
    if found != columns {
        let allowed = format!("shape (n, {columns})");
        return Err(refused(field, format!("of shape ({count}, {found})"), &allowed));
    }
    let row = |(index, row): (usize, numpy::ndarray::ArrayView1<'_, f64>)| {
        for (column, value) in row.iter().enumerate() {
            // Far outside the unit cube, reflections lose precision.
            if !(-1.0e6..=1.0e6).contains(value) {
                let name = format!("{field}[{index}, {column}]");
                return Err(refused(&name, value, "finite numbers from -1e6 to 1e6"));
            }
        }
        Ok(row.to_vec())
    };
    view.outer_iter().enumerate().map(row).collect()
}
