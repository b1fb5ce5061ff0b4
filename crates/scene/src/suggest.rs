//! "Did you mean": the declared word that is nearest to a misspelt one.

/// Longer words are nobody's slip of the finger.
const LONGEST: usize = 40;

/// The nearest of `candidates`, if it is near enough to be meant: one slip in three letters.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.chars().count() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .filter(|candidate| *candidate != word)
        .map(|candidate| (strsim::damerau_levenshtein(&lower, &candidate.to_lowercase()), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().min(lower.chars().count()) / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// `` `a`, `b` or `c` ``.
pub(crate) fn list<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    join(&quoted(words), "or")
}

/// `` `a`, `b` and `c` ``.
pub(crate) fn list_all<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    join(&quoted(words), "and")
}

/// `a, b and c`.
pub(crate) fn join(items: &[String], last: &str) -> String {
    match items.split_last() {
        Some((end, [])) => end.clone(),
        Some((end, start)) => format!("{} {last} {end}", start.join(", ")),
        None => String::new(),
    }
}

fn quoted<'a>(words: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    words.into_iter().map(|word| format!("`{word}`")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_recognised() {
        let words = ["diffuse", "phong", "mirror", "glass"];
        assert_eq!(nearest("difuse", words), Some("diffuse"));
        assert_eq!(nearest("Phong", words), Some("phong"));
        assert_eq!(nearest("mirorr", words), Some("mirror"));
    }

    #[test]
    fn strangers_are_not() {
        assert_eq!(nearest("teapot", ["diffuse", "phong"]), None);
        assert_eq!(nearest("q", ["p", "n"]), None);
        assert_eq!(nearest(&"x".repeat(100_000), ["phong"]), None);
    }

    #[test]
    fn lists_read_as_prose() {
        assert_eq!(list(["a"]), "`a`");
        assert_eq!(list(["a", "b", "c"]), "`a`, `b` or `c`");
        assert_eq!(list_all(["a", "b"]), "`a` and `b`");
    }
}
