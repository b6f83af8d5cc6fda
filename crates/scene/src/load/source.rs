//! The text that an error points into, and the arithmetic of lines and columns.

use std::ops::Range;

/// A text and the name it is shown under.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) name: String,
    pub(crate) text: String,
}

impl Source {
    pub(crate) fn new(name: impl Into<String>, text: String) -> Self {
        Self { name: name.into(), text }
    }

    /// Line and column of a byte, both from 1; columns count characters.
    pub(crate) fn position(&self, byte: usize) -> (usize, usize) {
        let line = self.line_of(byte);
        let before = &self.text[line.start..self.at_boundary(byte)];
        let lines_above = self.text[..line.start].bytes().filter(|&b| b == b'\n').count();
        (lines_above + 1, before.chars().count() + 1)
    }

    /// The bytes of the line around a byte, without its end.
    pub(crate) fn line_of(&self, byte: usize) -> Range<usize> {
        let byte = self.at_boundary(byte);
        let start = self.text[..byte].rfind('\n').map_or(0, |end| end + 1);
        let end = self.text[byte..].find('\n').map_or(self.text.len(), |offset| byte + offset);
        let end = start + self.text[start..end].trim_end_matches('\r').len();
        start..end
    }

    /// The bytes of one character at a line and a column in bytes, as `serde_json` counts them
    /// (from 1; column 0 is the end of the line before).
    pub(crate) fn offset(&self, line: usize, column: usize) -> Range<usize> {
        let lines = self.text.split_inclusive('\n').take(line.saturating_sub(1));
        let line_start: usize = lines.map(str::len).sum();
        let start = self.at_boundary((line_start + column).saturating_sub(1));
        let length = self.text[start..].chars().next().map_or(0, char::len_utf8);
        start..start + length
    }

    /// The span cut to the text and to whole characters.
    pub(crate) fn clip(&self, span: Range<usize>) -> Range<usize> {
        let start = self.at_boundary(span.start);
        start..self.at_boundary(span.end).max(start)
    }

    fn at_boundary(&self, byte: usize) -> usize {
        self.text.floor_char_boundary(byte.min(self.text.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_characters_and_survive_any_byte() {
        let source = Source::new("t", "aé\r\nü{".to_owned());
        assert_eq!(source.position(0), (1, 1));
        assert_eq!(source.position(3), (1, 3));
        assert_eq!(source.position(7), (2, 2));
        assert_eq!(&source.text[source.line_of(1)], "aé");
        for byte in 0..20 {
            source.position(byte);
            source.clip(byte..byte + 1);
        }
        for line in 0..4 {
            for column in 0..9 {
                source.offset(line, column);
            }
        }
    }
}
