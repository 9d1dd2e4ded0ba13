//! ULog, the flight log of PX4: the messages of a topic.
//!
//! A header of 16 bytes, then messages: size, type, content. Formats (`F`) define the topics, subscriptions (`A`) give them
//! numbers, and data (`D`) are their values, packed. [PX4 User Guide, ULog File Format]

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use super::cdr::Value;
use super::mcap_file::TopicRows;
use super::message::{Layout, RowError};
use super::ros2msg::{Count, Definitions, Element, Field, Number};
use super::{LogError, not_understood};

/// What a file begins with.
pub const MAGIC: [u8; 7] = [b'U', b'L', b'o', b'g', 0x01, 0x12, 0x35];
/// Length of the header, bytes.
const HEADER: usize = 16;
/// Types of messages.
const TYPES: &[u8] = b"BFIMPQARDLCSO";
/// Topics that are understood, and the types of ROS 2 with the same fields.
const KNOWN: [(&str, &str); 3] = [
    ("vehicle_local_position", "px4_msgs/VehicleLocalPosition"),
    ("trajectory_setpoint", "px4_msgs/TrajectorySetpoint"),
    ("vehicle_local_position_setpoint", "px4_msgs/VehicleLocalPositionSetpoint"),
];

/// A ULog file in memory.
pub struct File<'a> {
    /// Its name in messages.
    pub path: &'a Path,
    /// Its content.
    pub bytes: &'a [u8],
}

/// What a file defines and logs.
#[derive(Default)]
struct Content<'a> {
    types: HashMap<String, Vec<Field>>,
    /// Numbers of the topics: the name, with `:1` and so on for further instances.
    topics: BTreeMap<u16, String>,
    /// Type of every topic.
    kinds: BTreeMap<String, String>,
    data: Vec<(u16, &'a [u8])>,
    dropouts: usize,
    is_truncated: bool,
}

impl<'a> File<'a> {
    /// The rows of a topic: `vehicle_local_position`, or `vehicle_local_position:1` of a second instance.
    ///
    /// - `topic`: `None`: the position of the vehicle
    /// - `fields`: paths of the fields; empty: as the topic has them
    ///
    /// # Errors
    ///
    /// The file is damaged, the topic is missing or has no message, or its messages are not understood.
    pub fn rows(&self, topic: Option<&str>, fields: &[(String, String)]) -> Result<TopicRows, LogError> {
        let topic = topic.unwrap_or(KNOWN[0].0);
        let content = self.content()?;
        let number = content.topics.iter().find(|(_, name)| *name == topic).map(|(number, _)| *number);
        let no_topic = || self.no_topic(&content, topic);
        let (number, kind) = (number.ok_or_else(no_topic)?, content.kinds.get(topic).ok_or_else(no_topic)?);
        let layout = self.layout(topic, kind, fields)?;
        let definitions = Definitions::new(kind.clone(), content.types.clone());
        let (mut rows, mut remarks) = (Vec::new(), Vec::new());
        for (index, (_, data)) in content.data.iter().filter(|(of, _)| *of == number).enumerate() {
            let place = || format!("{topic}, message {}", index + 1);
            let value = Value::decode_packed(data, &definitions).map_err(|error| {
                not_understood(
                    self.path,
                    &place(),
                    &error.to_string(),
                    &format!("a message of {kind}"),
                    "is it damaged?",
                )
            })?;
            if remarks.is_empty() {
                remarks.push(layout.remark(topic, &value));
            }
            rows.extend(layout.rows(&value, 0).map_err(|error| error.at(self.path, &place(), kind, &value))?);
        }
        if rows.is_empty() {
            return Err(no_topic());
        }
        remarks.extend((content.dropouts > 0).then(|| format!("the log has {} dropouts", content.dropouts)));
        remarks.extend(content.is_truncated.then(|| "the log ends within a message".to_owned()));
        Ok(TopicRows { rows, remarks })
    }

    fn layout(&self, topic: &str, kind: &str, fields: &[(String, String)]) -> Result<Layout, LogError> {
        if !fields.is_empty() {
            return Layout::by_fields(fields).map_err(|name| RowError::field(self.path, topic, &name));
        }
        let known = KNOWN.iter().find(|(name, _)| *name == kind).and_then(|(_, as_type)| Layout::of(as_type));
        known.ok_or_else(|| {
            let expected = KNOWN.map(|(name, _)| name).join(", ");
            let remedy = "name the fields: `--field t=PATH --field x=PATH --field y=PATH --field z=PATH`";
            not_understood(self.path, topic, &format!("messages of {kind}"), &format!("one of {expected}"), remedy)
        })
    }

    fn content(&self) -> Result<Content<'a>, LogError> {
        let flaw = |reason: String| LogError::NotUlog { path: self.path.to_owned(), reason };
        let mut rest = self.bytes.get(HEADER..).ok_or_else(|| flaw("a file of fewer than 16 bytes".into()))?;
        let mut content = Content::default();
        while !rest.is_empty() {
            let at = self.bytes.len() - rest.len();
            let message = rest.split_first_chunk::<3>().and_then(|([low, high, kind], after)| {
                let size = usize::from(u16::from_le_bytes([*low, *high]));
                Some((*kind, after.split_at_checked(size)?))
            });
            let Some((kind, (body, after))) = message else {
                content.is_truncated = true;
                break;
            };
            if !TYPES.contains(&kind) {
                return Err(flaw(format!("a message of the unknown type {kind:#04x} at byte {at}")));
            }
            content.add(kind, body).ok_or_else(|| flaw(format!("a message that is not understood at byte {at}")))?;
            rest = after;
        }
        Ok(content)
    }

    fn no_topic(&self, content: &Content<'_>, topic: &str) -> LogError {
        let topics: Vec<&str> = content.topics.values().map(String::as_str).collect();
        let topics = if topics.is_empty() { "none".to_owned() } else { topics.join(", ") };
        LogError::NoTopic { path: self.path.to_owned(), found: format!("no message of `{topic}`"), topics }
    }
}

impl<'a> Content<'a> {
    /// Adds a message; `None` if it is not one.
    fn add(&mut self, kind: u8, body: &'a [u8]) -> Option<()> {
        match kind {
            // Of the flags that change how a file is read, the first is known: data appended after a crash, which are left out.
            b'B' => {
                let unknown = body.get(8..16)?.iter().enumerate();
                unknown.into_iter().all(|(index, byte)| *byte == 0 || (index == 0 && *byte == 1)).then_some(())
            }
            b'F' => {
                let (name, fields) = std::str::from_utf8(body).ok()?.split_once(':')?;
                let fields: Option<Vec<Field>> =
                    fields.split(';').map(str::trim).filter(|it| !it.is_empty()).map(field).collect();
                self.types.insert(name.to_owned(), without_last_padding(fields?));
                Some(())
            }
            b'A' => {
                let ([instance, low, high], name) = body.split_first_chunk::<3>()?;
                let kind = std::str::from_utf8(name).ok()?.to_owned();
                let topic = if *instance == 0 { kind.clone() } else { format!("{kind}:{instance}") };
                self.kinds.insert(topic.clone(), kind);
                self.topics.insert(u16::from_le_bytes([*low, *high]), topic);
                Some(())
            }
            b'D' => {
                let (number, data) = body.split_first_chunk::<2>()?;
                self.data.push((u16::from_le_bytes(*number), data));
                Some(())
            }
            b'O' => {
                self.dropouts += 1;
                Some(())
            }
            _ => Some(()),
        }
    }
}

/// A field as a format has it: `float[3] position`.
fn field(text: &str) -> Option<Field> {
    let (kind, name) = text.split_once(' ')?;
    let (kind, count) = match kind.split_once('[') {
        None => (kind, Count::One),
        Some((kind, count)) => (kind, Count::Fixed(count.strip_suffix(']')?.parse().ok()?)),
    };
    let element = match kind {
        "uint8_t" | "bool" | "char" => Element::Number(Number::Unsigned(1)),
        "uint16_t" => Element::Number(Number::Unsigned(2)),
        "uint32_t" => Element::Number(Number::Unsigned(4)),
        "uint64_t" => Element::Number(Number::Unsigned(8)),
        "int8_t" => Element::Number(Number::Signed(1)),
        "int16_t" => Element::Number(Number::Signed(2)),
        "int32_t" => Element::Number(Number::Signed(4)),
        "int64_t" => Element::Number(Number::Signed(8)),
        "float" => Element::Number(Number::Float(4)),
        "double" => Element::Number(Number::Float(8)),
        other => Element::Message(other.to_owned()),
    };
    Some(Field { name: name.to_owned(), element, count })
}

/// Padding at the end of a message is not logged.
fn without_last_padding(mut fields: Vec<Field>) -> Vec<Field> {
    if fields.last().is_some_and(|field| field.name.starts_with("_padding")) {
        fields.pop();
    }
    fields
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{File, MAGIC};

    fn message(kind: u8, body: &[u8]) -> Vec<u8> {
        [&(body.len() as u16).to_le_bytes()[..], &[kind], body].concat()
    }

    fn position(us: u64, [x, y, z]: [f32; 3], xy_valid: u8) -> Vec<u8> {
        let numbers = [x, y, z, 1.0, 2.0, 3.0].map(f32::to_le_bytes).concat();
        message(b'D', &[&[7, 0][..], &us.to_le_bytes(), &numbers, &[xy_valid, 1]].concat())
    }

    fn log(data: &[Vec<u8>]) -> Vec<u8> {
        let format = "vehicle_local_position:uint64_t timestamp;float x;float y;float z;float vx;float vy;float vz;\
                      bool xy_valid;bool z_valid;uint8_t[6] _padding0;";
        let subscription = [&[0, 7, 0][..], b"vehicle_local_position"].concat();
        let start =
            [&MAGIC[..], &[1], &[0; 8], &message(b'F', format.as_bytes()), &message(b'A', &subscription)].concat();
        [start, data.concat()].concat()
    }

    fn rows(bytes: &[u8]) -> Result<super::TopicRows, String> {
        File { path: Path::new("log.ulg"), bytes }.rows(None, &[]).map_err(|error| error.to_string())
    }

    #[test]
    fn positions_are_read_and_converted() {
        let found = rows(&log(&[position(5_000_000, [1.0, 2.0, -3.0], 1), message(b'O', &[9, 0])])).unwrap();
        let row = found.rows[0];
        assert_eq!((row.t_ns, row.position_m), (5_000_000_000, [2.0, 1.0, 3.0]));
        assert_eq!(row.velocity_mps, Some([2.0, 1.0, -3.0]));
        assert!(found.remarks.iter().any(|remark| remark.contains("1 dropouts")), "{:?}", found.remarks);
    }

    #[test]
    fn positions_that_the_estimator_calls_invalid_are_refused() {
        let refused = rows(&log(&[position(0, [0.0; 3], 1), position(9, [0.0; 3], 0)])).err().expect("invalid");
        assert!(refused.contains("message 2") && refused.contains("xy_valid"), "{refused}");
    }

    #[test]
    fn a_truncated_log_ends_with_its_last_whole_message_and_damage_is_named() {
        let whole = log(&[position(0, [0.0; 3], 1), position(9, [0.0; 3], 1)]);
        let found = rows(&whole[..whole.len() - 1]).unwrap();
        assert_eq!(
            (found.rows.len(), found.remarks.last().map(String::as_str)),
            (1, Some("the log ends within a message"))
        );
        for length in 0..whole.len() {
            let _ = rows(&whole[..length]);
        }
        let unknown = [whole, message(b'Z', &[])].concat();
        assert!(rows(&unknown).err().expect("damage").contains("unknown type 0x5a"));
    }
}
