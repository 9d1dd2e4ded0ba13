//! Definitions of ROS 2 messages, as a bag carries them (`ros2msg`): the fields of a type, and those of the types that it uses,
//! each after a line of `=` and a line `MSG: package/Type`.

use std::collections::HashMap;

/// The fields of every type that a message may hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Definitions {
    /// Name of the message's own type.
    pub root: String,
    types: HashMap<String, Vec<Field>>,
}

/// A field of a message.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What each of its elements is.
    pub element: Element,
    /// How many elements it has.
    pub count: Count,
}

/// The type of an element.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    /// A number of this many bytes.
    Number(Number),
    /// A text.
    Text,
    /// A message of this type.
    Message(String),
}

/// The representation of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Unsigned, of this many bytes; `bool`, `byte` and `char` too.
    Unsigned(usize),
    /// Signed, of this many bytes.
    Signed(usize),
    /// Floating point, of 4 or 8 bytes.
    Float(usize),
}

/// The number of elements of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// One, which is no list.
    One,
    /// This many, without a length before them.
    Fixed(usize),
    /// As many as the length before them says.
    Sequence,
}

/// Types that every message may use without defining them.
const BUILT_IN: [(&str, &str); 2] = [
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec"),
    ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"),
];

impl Definitions {
    /// Definitions that were read elsewhere.
    pub fn new(root: String, types: HashMap<String, Vec<Field>>) -> Self {
        Self { root, types }
    }

    /// Reads the text of a schema.
    ///
    /// - `root`: name of the message's type: `nav_msgs/msg/Odometry`
    ///
    /// # Errors
    ///
    /// The line that is not understood.
    pub fn parse(root: &str, text: &str) -> Result<Self, NotUnderstood> {
        let root = plain(root);
        let mut types: HashMap<String, Vec<Field>> = HashMap::new();
        for (name, text) in BUILT_IN {
            types.insert(name.to_owned(), fields(name, text.lines())?);
        }
        let (mut name, mut lines): (String, Vec<&str>) = (root.clone(), Vec::new());
        for line in text.lines().chain(["==="]) {
            let line = line.trim();
            if line.len() >= 3 && line.chars().all(|c| c == '=') {
                if !name.is_empty() {
                    types.insert(name.clone(), fields(&name, lines.drain(..))?);
                }
                name.clear();
            } else if let Some(next) = line.strip_prefix("MSG:").filter(|_| name.is_empty()) {
                name = plain(next.trim());
            } else {
                lines.push(line);
            }
        }
        Ok(Self { root, types })
    }

    /// The fields of a type; `None` if it is not defined.
    pub fn fields(&self, name: &str) -> Option<&[Field]> {
        self.types.get(name).map(Vec::as_slice)
    }
}

/// A line of a schema that is not understood.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the definition of {of} has a line `{line}`, where a type and a name are expected")]
pub struct NotUnderstood {
    /// The type that it defines.
    pub of: String,
    /// The line.
    pub line: String,
}

/// `package/Type` of `package/msg/Type`.
fn plain(name: &str) -> String {
    name.replace("/msg/", "/")
}

fn fields<'t>(of: &str, lines: impl Iterator<Item = &'t str>) -> Result<Vec<Field>, NotUnderstood> {
    let mut fields = Vec::new();
    for line in lines {
        // A text may hold a `#`, but only in a default value, which is not needed.
        let content = line.split('#').next().unwrap_or_default().trim();
        let mut words = content.split_whitespace();
        let Some(kind) = words.next() else { continue };
        let not_understood = || NotUnderstood { of: of.to_owned(), line: line.to_owned() };
        let name = words.next().ok_or_else(not_understood)?;
        let is_constant = name.contains('=') || words.next().is_some_and(|word| word.starts_with('='));
        if !is_constant {
            fields.push(field(of, kind, name).ok_or_else(not_understood)?);
        }
    }
    Ok(fields)
}

fn field(of: &str, kind: &str, name: &str) -> Option<Field> {
    let (kind, count) = match kind.split_once('[') {
        None => (kind, Count::One),
        Some((kind, rest)) => match rest.strip_suffix(']')? {
            bounds if bounds.is_empty() || bounds.starts_with("<=") => (kind, Count::Sequence),
            count => (kind, Count::Fixed(count.parse().ok()?)),
        },
    };
    // The bound of a text: string<=10.
    let kind = kind.split_once("<=").map_or(kind, |(kind, _)| kind);
    let element = match kind {
        "bool" | "byte" | "char" | "uint8" => Element::Number(Number::Unsigned(1)),
        "uint16" => Element::Number(Number::Unsigned(2)),
        "uint32" => Element::Number(Number::Unsigned(4)),
        "uint64" => Element::Number(Number::Unsigned(8)),
        "int8" => Element::Number(Number::Signed(1)),
        "int16" => Element::Number(Number::Signed(2)),
        "int32" => Element::Number(Number::Signed(4)),
        "int64" => Element::Number(Number::Signed(8)),
        "float32" => Element::Number(Number::Float(4)),
        "float64" => Element::Number(Number::Float(8)),
        "string" => Element::Text,
        "wstring" => return None,
        "time" => Element::Message("builtin_interfaces/Time".into()),
        "duration" => Element::Message("builtin_interfaces/Duration".into()),
        "Header" => Element::Message("std_msgs/Header".into()),
        other if other.contains('/') => Element::Message(plain(other)),
        other => Element::Message(format!("{}/{other}", of.split('/').next()?)),
    };
    Some(Field { name: name.to_owned(), element, count })
}

#[cfg(test)]
mod tests {
    use super::{Count, Definitions, Element, Number};

    const TEXT: &str = "\
# A path.
std_msgs/Header header   # its frame
geometry_msgs/PoseStamped[] poses
uint8 NONE=0
uint8 SOME = 1
string<=10 name \"a # b\"
float32[3] position
uint16[<=4] few
Point at
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/msg/PoseStamped
std_msgs/Header header
";

    #[test]
    fn the_fields_of_all_types_are_found() {
        let definitions = Definitions::parse("nav_msgs/msg/Path", TEXT).unwrap();
        let fields = definitions.fields("nav_msgs/Path").unwrap();
        let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["header", "poses", "name", "position", "few", "at"]);
        assert_eq!(
            (fields[1].count, fields[3].count, fields[4].count),
            (Count::Sequence, Count::Fixed(3), Count::Sequence)
        );
        assert_eq!(fields[3].element, Element::Number(Number::Float(4)));
        assert_eq!(fields[5].element, Element::Message("nav_msgs/Point".into()));
        assert_eq!(definitions.fields("std_msgs/Header").unwrap().len(), 2);
        assert_eq!(definitions.fields("geometry_msgs/PoseStamped").unwrap().len(), 1);
        assert_eq!(definitions.fields("builtin_interfaces/Time").unwrap().len(), 2);
        assert!(definitions.fields("nav_msgs/Point").is_none());
    }

    #[test]
    fn lines_that_are_no_fields_are_named() {
        for line in ["float32", "float32[x] a", "float32[3 a", "wstring name"] {
            let error = Definitions::parse("a/B", line).unwrap_err();
            assert_eq!(error.line, line);
        }
    }
}
