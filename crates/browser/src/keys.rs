//! Keys as the protocol names them.

use serde_json::{Value, json};

/// Keys held down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// The shift key.
    pub shift: bool,
    /// The control key.
    pub control: bool,
}

/// Named keys with their codes of Windows, which the protocol still wants.
const NAMED: [(&str, u32); 13] = [
    ("Enter", 13),
    ("Escape", 27),
    ("Tab", 9),
    ("PageUp", 33),
    ("PageDown", 34),
    ("End", 35),
    ("Home", 36),
    ("ArrowLeft", 37),
    ("ArrowUp", 38),
    ("ArrowRight", 39),
    ("ArrowDown", 40),
    ("Delete", 46),
    ("Backspace", 8),
];

/// Parameters of `Input.dispatchKeyEvent` for pressing and releasing a key: a name such as
/// `ArrowLeft`, or the character that it types.
pub(crate) fn events(key: &str, modifiers: Modifiers) -> [Value; 2] {
    let held = u32::from(modifiers.control) * 2 + u32::from(modifiers.shift) * 8;
    let named = NAMED.iter().find(|named| named.0 == key);
    let (code, number, text) = match named {
        Some(&(name, number)) => (name.to_owned(), number, if name == "Enter" { "\r" } else { "" }),
        None => (code(key), number(key), key),
    };
    let event = |kind: &str, text: &str| {
        let mut event = json!({
            "type": kind, "key": key, "code": code, "modifiers": held,
            "windowsVirtualKeyCode": number,
        });
        if !text.is_empty() {
            event["text"] = json!(text);
        }
        event
    };
    let down = if text.is_empty() { "rawKeyDown" } else { "keyDown" };
    [event(down, text), event("keyUp", "")]
}

fn first(key: &str) -> char {
    key.chars().next().unwrap_or(' ').to_ascii_uppercase()
}

fn code(key: &str) -> String {
    match first(key) {
        ' ' => "Space".to_owned(),
        digit @ '0'..='9' => format!("Digit{digit}"),
        letter @ 'A'..='Z' => format!("Key{letter}"),
        _ => String::new(),
    }
}

fn number(key: &str) -> u32 {
    match first(key) {
        plain @ (' ' | '0'..='9' | 'A'..='Z') => u32::from(plain),
        _ => 0,
    }
}
