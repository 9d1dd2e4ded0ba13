//! The layout of a text table: its header, its separator, and where its rows begin.

use csv::{ReaderBuilder, StringRecord};

use super::PlanIssue;
use crate::Issue;

/// What a line of a comment begins with.
const COMMENT_MARKS: [char; 2] = ['#', '%'];
/// Separators, in the order in which they are tried; after them, spaces.
const SEPARATORS: [char; 3] = [',', ';', '\t'];
/// Columns of the format of the TUM RGB-D benchmark, which has no header.
const TUM: [&str; 8] = ["t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"];

/// A text table, its rows not yet read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// Names of the columns as the file gives them.
    pub names: Vec<String>,
    /// Between two cells; `None`: one or more spaces.
    pub separator: Option<char>,
    /// Line of the header, from 1.
    pub header_line: usize,
    /// The rows, each with its line, from 1; comments and empty lines are left out.
    pub rows: Vec<(usize, String)>,
    /// Whether the table is in the TUM format, whose times need not begin at 0.
    pub is_tum: bool,
}

impl Layout {
    /// Finds header and separator.
    ///
    /// The header is the first line. If that holds a number, it is the comment before it, as NumPy writes it; without one, a
    /// table of eight columns of numbers is in the TUM format.
    pub fn of(text: &str) -> Result<Self, Vec<PlanIssue>> {
        let mut lines =
            text.lines().enumerate().map(|(index, line)| (index + 1, line.trim())).filter(|(_, line)| !line.is_empty());
        let mut comment = None;
        let first = loop {
            match lines.next() {
                Some((number, line)) if line.starts_with(COMMENT_MARKS) => comment = Some((number, uncommented(line))),
                first => break first,
            }
        };
        let Some((number, line)) = first.or(comment) else { return Err(no_header("an empty file".into(), 1)) };
        let separator = separator(line);
        let cells = split(line, separator);
        let rest =
            lines.filter(|(_, line)| !line.starts_with(COMMENT_MARKS)).map(|(number, line)| (number, line.to_owned()));
        let is_number = |cell: &&str| cell.parse::<f64>().is_ok();
        // The names of columns are no numbers.
        if !cells.iter().any(is_number) {
            return Ok(Self {
                names: owned(&cells),
                separator,
                header_line: number,
                rows: rest.collect(),
                is_tum: false,
            });
        }
        let rows = std::iter::once((number, line.to_owned())).chain(rest).collect();
        let named = comment.map(|(number, line)| (number, split(line, self::separator(line))));
        if let Some((header_line, names)) = named.filter(|(_, names)| names.len() == cells.len()) {
            return Ok(Self { names: owned(&names), separator, header_line, rows, is_tum: false });
        }
        if cells.len() == TUM.len() && cells.iter().all(is_number) {
            return Ok(Self { names: owned(&TUM), separator, header_line: number, rows, is_tum: true });
        }
        Err(no_header(format!("a row of {} values", cells.len()), number))
    }

    /// The rows of a table, each with its line.
    pub fn records(&self) -> impl Iterator<Item = Result<(usize, StringRecord), csv::Error>> {
        let row = |(_, row): &(usize, String)| match self.separator {
            Some(_) => row.clone(),
            None => row.split_whitespace().collect::<Vec<_>>().join(","),
        };
        let text = self.rows.iter().map(row).collect::<Vec<_>>().join("\n");
        let lines: Vec<usize> = self.rows.iter().map(|(line, _)| *line).collect();
        let separator = self.separator.unwrap_or(',') as u8;
        let mut builder = ReaderBuilder::new();
        builder.has_headers(false).flexible(true).trim(csv::Trim::All).delimiter(separator);
        let records = builder.from_reader(std::io::Cursor::new(text)).into_records();
        records.map(move |record| {
            let record = record?;
            let row = record.position().map_or(1, |position| position.line() as usize);
            Ok((lines.get(row - 1).copied().unwrap_or(0), record))
        })
    }
}

fn no_header(found: String, line: usize) -> Vec<PlanIssue> {
    let expected = "a first line with the names of the columns: vehicle,t_s,x_m,y_m,z_m,...";
    let remedy = "`harness check --help` lists the columns; eight numbers in a row would be the TUM format";
    vec![PlanIssue::new(format!(":{line}"), Issue::new("header", found, expected).remedy(remedy))]
}

fn uncommented(line: &str) -> &str {
    line.trim_start_matches(COMMENT_MARKS).trim()
}

fn separator(line: &str) -> Option<char> {
    SEPARATORS.into_iter().find(|separator| line.contains(*separator))
}

fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    match separator {
        Some(separator) => line.split(separator).map(unquoted).collect(),
        None => line.split_whitespace().map(unquoted).collect(),
    }
}

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(cell).trim()
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::Layout;

    #[test]
    fn headers_are_found_in_the_usual_places() {
        for (text, names, separator, rows) in [
            ("t,x\n0,1\n", "t x", Some(','), 1),
            ("# made by hand\n# t,x\n0,1\n1,2\n", "t x", Some(','), 2),
            ("#t x\n0 1\n", "t x", None, 1),
            ("\n% note\nt;x\n# aside\n0;1\n", "t x", Some(';'), 1),
            ("t\tx\n0\t1\n", "t x", Some('\t'), 1),
            ("# t,x\n", "t x", Some(','), 0),
        ] {
            let layout = Layout::of(text).unwrap();
            assert_eq!(
                (layout.names.join(" ").as_str(), layout.separator, layout.rows.len()),
                (names, separator, rows),
                "{text}"
            );
        }
    }

    #[test]
    fn eight_numbers_in_a_row_are_the_tum_format_and_others_have_no_header() {
        let layout = Layout::of("# timestamp tx ty\n1403.5 0 0 1 0 0 0 1\n").unwrap();
        assert!(layout.is_tum && layout.rows == [(2, "1403.5 0 0 1 0 0 0 1".to_owned())]);
        assert!(Layout::of("0,1,2\n").is_err() && Layout::of("").is_err() && Layout::of("\n\n").is_err());
    }
}
