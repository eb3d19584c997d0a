//! Numbers as authored: the typed document holds f32, the JSON what was written.

use serde_json::Value;

/// The numbers at a JSON pointer; `typed`, which may be a default, where there are none.
pub(super) fn exact<const N: usize>(json: &Value, pointer: &str, typed: [f32; N]) -> [f64; N] {
    let authored = json.pointer(pointer).and_then(Value::as_array);
    let authored = authored.filter(|numbers| numbers.len() == N);
    std::array::from_fn(|i| {
        let number = authored.and_then(|numbers| numbers.get(i)?.as_f64());
        number.unwrap_or(f64::from(typed[i]))
    })
}

/// The number at a JSON pointer, likewise.
pub(super) fn exact_one(json: &Value, pointer: &str, typed: f32) -> f64 {
    let authored = json.pointer(pointer).and_then(Value::as_f64);
    authored.unwrap_or(f64::from(typed))
}
