//! Randomly damaged copies of an input.

use rand::Rng;

/// Words and symbols that have a meaning in some format.
const WORDS: [&str; 14] = [
    "nan",
    "NaN",
    "inf",
    "-1",
    "1e309",
    "null",
    "\"\"",
    "[",
    "}",
    ",",
    "\n",
    "\u{fffd}",
    "99999999999999999999",
    "[[vehicles]]",
];

/// `count` copies of `text`, each with one to four changes: a byte replaced, a piece removed, a piece duplicated, or a word
/// inserted. The same on every call.
pub fn copies_of(text: &str, count: usize) -> impl Iterator<Item = String> + '_ {
    let mut rng = scenarios::stream(0, "damage");
    (0..count).map(move |_| {
        let mut below = |n: usize| (rng.next_u64() % n.max(1) as u64) as usize;
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..=below(4) {
            let (at, length) = (below(bytes.len()), 1 + below(20));
            let end = (at + length).min(bytes.len());
            match below(4) {
                0 if !bytes.is_empty() => bytes[at] = below(256) as u8,
                1 => drop(bytes.drain(at..end)),
                2 => {
                    let piece = bytes[at..end].to_vec();
                    bytes.splice(at..at, piece);
                }
                _ => drop(bytes.splice(at..at, WORDS[below(WORDS.len())].bytes())),
            }
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}
