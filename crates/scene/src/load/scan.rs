//! Text to tree.
//!
//! `serde_json` judges the text first: it is strict JSON, its numbers are finite, and it is not
//! nested deeper than the stack bears. This scanner then walks the same text once more only to
//! note where every value stands, decoding strings and numbers through `serde_json` again, so the
//! two can never disagree. What is added: a key may occur only once in an object.

use std::collections::BTreeMap;
use std::ops::Range;

use super::source::Source;
use super::tree::{Member, Node, Value};
use super::trouble::{Site, Trouble};

/// Reads a text as one JSON value.
pub(crate) fn scan(source: &Source) -> Result<Node, Trouble> {
    let text = source.text.as_str();
    if let Err(error) = serde_json::from_str::<serde_json::Value>(text) {
        return Err(syntax_error(source, &error));
    }
    let mut scanner = Scanner { source, at: 0 };
    let mut root = scanner.value()?;
    root.renumber();
    Ok(root)
}

fn syntax_error(source: &Source, error: &serde_json::Error) -> Trouble {
    let at = source.offset(error.line(), error.column());
    let text = error.to_string();
    // serde_json ends its message with the position, which is shown anyway.
    let message = text.rsplit_once(" at line ").map_or(text.as_str(), |(message, _)| message);
    let start = at.start;
    let mut trouble = Trouble::new(format!("not valid JSON: {message}")).at_bytes(at);
    if message.starts_with("trailing comma") {
        trouble = trouble.hint("JSON allows no comma after the last entry");
    } else if source.text.starts_with('\u{feff}') {
        trouble = trouble.hint("the file starts with a byte order mark; save it without one");
    } else if source.text.trim_start().starts_with('<') {
        trouble = trouble.hint("this looks like Mitsuba's XML; scenes are JSON dictionaries here");
    } else if message.starts_with("number out of range") {
        trouble = trouble.hint("numbers must be less than 1.8e308");
    } else if ["NaN", "nan", "Inf", "inf"].iter().any(|w| source.text[start..].starts_with(w)) {
        trouble = trouble.hint("JSON has no NaN and no infinity");
    } else if message.starts_with("recursion limit") {
        trouble = trouble.hint("no scene needs values nested this deeply");
    }
    trouble
}

struct Scanner<'a> {
    source: &'a Source,
    at: usize,
}

impl Scanner<'_> {
    fn value(&mut self) -> Result<Node, Trouble> {
        self.skip_space();
        let start = self.at;
        let value = match self.peek() {
            Some(b'{') => Value::Object(self.object()?),
            Some(b'[') => Value::Array(self.array()?),
            Some(b'"') => Value::String(self.string()?.0),
            _ => self.word()?,
        };
        Ok(Node { id: 0, span: start..self.at, from_override: None, value })
    }

    fn array(&mut self) -> Result<Vec<Node>, Trouble> {
        let mut items = Vec::new();
        self.at += 1;
        while !self.closes(b']') {
            items.push(self.value()?);
        }
        Ok(items)
    }

    fn object(&mut self) -> Result<Vec<Member>, Trouble> {
        let mut members: Vec<Member> = Vec::new();
        let mut first_of = BTreeMap::new();
        self.at += 1;
        while !self.closes(b'}') {
            let (key, key_span) = self.string()?;
            if let Some(first) = first_of.insert(key.clone(), key_span.start) {
                let (line, _) = self.source.position(first);
                return Err(Trouble::new(format!("the key `{key}` occurs twice in this object"))
                    .at_bytes(key_span)
                    .hint(format!("it occurs first in line {line}; rename or delete one")));
            }
            self.skip_space();
            self.at += 1; // the colon
            let value = self.value()?;
            members.push(Member { key, key_span, value });
        }
        Ok(members)
    }

    /// Skips space and a comma; consumes the closing bracket if that is what follows (or nothing).
    fn closes(&mut self, bracket: u8) -> bool {
        self.skip_space();
        if self.peek() == Some(b',') {
            self.at += 1;
            self.skip_space();
        }
        let closes = self.peek().is_none_or(|byte| byte == bracket);
        if closes {
            self.at = (self.at + 1).min(self.source.text.len());
        }
        closes
    }

    fn string(&mut self) -> Result<(String, Range<usize>), Trouble> {
        let start = self.at;
        let bytes = self.source.text.as_bytes();
        self.at += 1;
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b'"' => break,
                b'\\' => self.at += 2,
                _ => self.at += 1,
            }
        }
        self.at = (self.at + 1).min(bytes.len());
        let span = start..self.at;
        Ok((self.decode(span.clone())?, span))
    }

    /// A number, `true`, `false` or `null`.
    fn word(&mut self) -> Result<Value, Trouble> {
        let start = self.at;
        while self.peek().is_some_and(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b)) {
            self.at += 1;
        }
        Ok(match self.decode::<serde_json::Value>(start..self.at)? {
            serde_json::Value::Bool(value) => Value::Bool(value),
            serde_json::Value::Number(number) => Value::Number(number),
            _ => Value::Null,
        })
    }

    fn decode<T: serde::de::DeserializeOwned>(&self, span: Range<usize>) -> Result<T, Trouble> {
        let text = self.source.text.get(span.clone()).unwrap_or_default();
        serde_json::from_str(text).map_err(|error| Trouble {
            site: Some(Site::Bytes(span)),
            ..Trouble::new(format!("not valid JSON: {error}"))
        })
    }

    fn peek(&self) -> Option<u8> {
        self.source.text.as_bytes().get(self.at).copied()
    }

    fn skip_space(&mut self) {
        while self.peek().is_some_and(|byte| b" \t\r\n".contains(&byte)) {
            self.at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_knows_its_bytes_and_equals_what_serde_json_reads() {
        let text = "{\"a\": [1, -2.5e3, \"x\\ud83d\\ude00\\\"y\"],\n \"b\\u0041\": {\"c\": null}}";
        let source = Source::new("test.json", text.to_owned());
        let root = scan(&source).expect("this is JSON");
        let direct: serde_json::Value = serde_json::from_str(text).expect("this is JSON");
        assert_eq!(root.to_json(), direct);
        let number = root.get("a").expect("a").element_or_self(1);
        assert_eq!(&text[number.span.clone()], "-2.5e3");
        assert_eq!(root.locate(number.id).expect("it is there").path, ".a[1]");
        let c = root.get("bA").and_then(|b| b.get("c")).expect("b.c");
        assert_eq!(&text[c.span.clone()], "null");
        assert_eq!(root.locate(c.id).expect("it is there").path, ".bA.c");
    }
}
