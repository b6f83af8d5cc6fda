//! Names in messages: which one was meant, and which ones there are.

use std::cmp::Reverse;

/// "did you mean ...?", where one of the candidates is near enough.
pub(crate) fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    nearest(word, candidates).map(|name| format!("did you mean `{name}`?"))
}

/// The candidate that a misspelt word most likely means.
pub(crate) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    // Names are short; a long word (or a hostile one) is no slip of the pen.
    if word.len() > 64 {
        return None;
    }
    let lower = word.to_lowercase();
    let likeness = |name: &'a str| {
        let lower_name = name.to_lowercase();
        let edits = strsim::damerau_levenshtein(&lower, &lower_name);
        let allowed = (lower.chars().count().max(lower_name.chars().count()) / 3).max(1);
        let part = lower.len() >= 3 && (lower_name.contains(&lower) || lower.contains(&lower_name));
        let near = edits <= allowed || (part && lower_name.len() >= 3);
        let shared = lower.chars().zip(lower_name.chars()).take_while(|(a, b)| a == b).count();
        near.then_some((edits, Reverse(shared), name))
    };
    let near = candidates.into_iter().filter_map(likeness);
    near.min_by_key(|&(edits, shared, _)| (edits, shared)).map(|(_, _, name)| name)
}

/// "one of `a`, `b`, `c`".
pub(crate) fn one_of(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [first, second] => format!("{first} or {second}"),
        many => format!("one of {}", many.join(", ")),
    }
}

/// The beginning of a text that may be very long.
pub(crate) fn shortened(text: &str) -> String {
    const KEPT: usize = 60;
    match text.char_indices().nth(KEPT) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_find_their_name_and_other_words_do_not() {
        let names = ["sigma_t", "albedo", "phase", "specular_reflectance"];
        assert_eq!(nearest("phse", names), Some("phase"));
        assert_eq!(nearest("Sigma_T", names), Some("sigma_t"));
        assert_eq!(nearest("reflectance", names), Some("specular_reflectance"));
        assert_eq!(nearest("bin_width", ["width", "bin_width_opl"]), Some("bin_width_opl"));
        assert_eq!(nearest("banana", names), None);
        assert_eq!(nearest("", names), None);
    }
}
