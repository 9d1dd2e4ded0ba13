/// The candidate with the smallest edit distance to `word` (insertions, deletions, substitutions), for "did you mean".
///
/// `None` if more than a third of the longer of the two words would have to change. A missing or superfluous unit
/// (`mass` for `mass_kg`) counts as one edit.
///
/// # Examples
///
/// ```
/// use scenarios::closest_name;
///
/// assert_eq!(closest_name("margins_m", ["margin_m", "name"]), Some("margin_m"));
/// assert_eq!(closest_name("colour", ["margin_m", "name"]), None);
/// ```
pub fn closest_name<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    candidates
        .into_iter()
        .map(|candidate| (edits(word, candidate), candidate))
        .filter(|(edits, candidate)| 3 * edits <= word.chars().count().max(candidate.chars().count()))
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate)
}

fn edits(word: &str, candidate: &str) -> usize {
    let differs_by_unit = |a: &str, b: &str| a.strip_prefix(b).is_some_and(|rest| rest.starts_with('_'));
    if differs_by_unit(word, candidate) || differs_by_unit(candidate, word) {
        1
    } else {
        edit_distance(word, candidate)
    }
}

/// Levenshtein distance, computed one row of the table at a time.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::{closest_name, edit_distance};

    #[test]
    fn edit_distance_matches_textbook_values() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
        assert_eq!(edit_distance("speed_mps", "speed_mps"), 0);
    }

    #[test]
    fn a_typo_has_a_closest_name_and_nonsense_has_none() {
        let keys = ["margin_m", "max_iterations", "name"];
        assert_eq!(closest_name("margins_m", keys), Some("margin_m"));
        assert_eq!(closest_name("margin", keys), Some("margin_m"));
        assert_eq!(closest_name("nam", keys), Some("name"));
        assert_eq!(closest_name("colour", keys), None);
    }
}
