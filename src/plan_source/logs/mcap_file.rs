//! MCAP files: the messages of a topic.

use std::collections::BTreeMap;
use std::path::Path;

use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{Channel, McapResult, MessageStream};

use super::cdr::Value;
use super::message::{KNOWN, Layout, Row, RowError};
use super::ros2msg::Definitions;
use super::{LogError, not_understood};

/// The largest record or chunk that is read, bytes: the lengths in a damaged file may be any number.
const MAX_RECORD_BYTES: usize = 1 << 28;

/// An MCAP file in memory.
pub struct File<'a> {
    /// Its name in messages.
    pub path: &'a Path,
    /// Its content.
    pub bytes: &'a [u8],
}

/// The rows of a topic, and what the user should know of how they were read.
pub struct TopicRows {
    /// In the order of the file.
    pub rows: Vec<Row>,
    /// One per topic.
    pub remarks: Vec<String>,
}

impl File<'_> {
    /// The rows of a topic.
    ///
    /// - `topic`: `None`: the only one whose type is known
    /// - `fields`: paths of the fields; empty: as the type has them
    ///
    /// # Errors
    ///
    /// The file is not whole, the topic is missing or has no message, or its messages are not understood.
    pub fn rows(&self, topic: Option<&str>, fields: &[(String, String)]) -> Result<TopicRows, LogError> {
        let topic = topic.map_or_else(|| self.only_topic(), |topic| Ok(topic.to_owned()))?;
        let mut reader: Option<TopicReader<'_>> = None;
        let (mut rows, mut remarks, mut count) = (Vec::new(), Vec::<String>::new(), 0);
        for message in self.messages()? {
            let message = message.map_err(|error| self.not_mcap(&error))?;
            if message.channel.topic != topic {
                continue;
            }
            count += 1;
            let reader = match &mut reader {
                Some(reader) => reader,
                none => none.insert(TopicReader::new(self, &message.channel, fields)?),
            };
            let value = reader.decode(&message.data, count)?;
            let remark = reader.layout.remark(&topic, &value);
            match remarks.first() {
                Some(first) if *first != remark && !reader.layout.is_whole() => {
                    return Err(reader.mixed(count, &remark, first));
                }
                Some(_) => {}
                None => remarks.push(remark),
            }
            let found = reader.rows(&value, i128::from(message.log_time), count)?;
            if reader.layout.is_whole() {
                rows = found;
            } else {
                rows.extend(found);
            }
        }
        let Some(reader) = reader else { return Err(self.no_topic(&format!("no message on `{topic}`"))) };
        if reader.layout.is_whole() && count > 1 {
            remarks.push(format!("{topic}: the last of {count} messages"));
        }
        Ok(TopicRows { rows, remarks })
    }

    fn messages(&self) -> Result<MessageStream<'_>, LogError> {
        self.check().and_then(|()| MessageStream::new(self.bytes)).map_err(|error| self.not_mcap(&error))
    }

    /// Reads the whole file once, with its checksums and within the largest length of a record, before its messages are believed.
    fn check(&self) -> McapResult<()> {
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_record_length_limit(MAX_RECORD_BYTES);
        let (mut reader, mut rest) = (LinearReader::new_with_options(options), self.bytes);
        while let Some(event) = reader.next_event() {
            if let LinearReadEvent::ReadRequest(wanted) = event? {
                let (next, after) = rest.split_at(wanted.min(rest.len()));
                reader.insert(next.len()).copy_from_slice(next);
                reader.notify_read(next.len());
                rest = after;
            }
        }
        Ok(())
    }

    fn not_mcap(&self, error: &mcap::McapError) -> LogError {
        LogError::NotMcap { path: self.path.to_owned(), reason: error.to_string() }
    }

    /// The only topic of a known type.
    fn only_topic(&self) -> Result<String, LogError> {
        let topics = self.topics()?;
        let mut known = topics.iter().filter(|(_, kind)| KNOWN.contains(&kind.as_str()));
        match (known.next(), known.next()) {
            (Some((topic, _)), None) => Ok(topic.clone()),
            (None, _) => Err(self.no_topic("no topic of a known type")),
            (Some(_), Some(_)) => Err(self.no_topic("several topics of known types")),
        }
    }

    /// Every topic with a message, and its type.
    fn topics(&self) -> Result<BTreeMap<String, String>, LogError> {
        let mut topics = BTreeMap::new();
        for message in self.messages()? {
            let channel = message.map_err(|error| self.not_mcap(&error))?.channel;
            topics.entry(channel.topic.clone()).or_insert_with(|| type_name(&channel));
        }
        Ok(topics)
    }

    fn no_topic(&self, found: &str) -> LogError {
        let topics = self.topics().unwrap_or_default();
        let named: Vec<String> = topics.iter().map(|(topic, kind)| format!("{topic} ({kind})")).collect();
        let topics = if named.is_empty() { "none, the file has no messages".to_owned() } else { named.join(", ") };
        LogError::NoTopic { path: self.path.to_owned(), found: found.to_owned(), topics }
    }
}

/// Name of the type of a channel, without `/msg/`.
fn type_name(channel: &Channel<'_>) -> String {
    channel.schema.as_ref().map_or_else(|| "no type".to_owned(), |schema| schema.name.replace("/msg/", "/"))
}

/// How the messages of a topic are read.
struct TopicReader<'a> {
    path: &'a Path,
    topic: String,
    kind: String,
    definitions: Definitions,
    layout: Layout,
}

impl<'a> TopicReader<'a> {
    fn new(file: &File<'a>, channel: &Channel<'_>, fields: &[(String, String)]) -> Result<Self, LogError> {
        let (path, topic, kind) = (file.path, channel.topic.clone(), type_name(channel));
        let wrong =
            |found: String, expected: &str, remedy: &str| not_understood(path, &topic, &found, expected, remedy);
        let schema = channel.schema.as_ref().filter(|schema| schema.encoding == "ros2msg");
        let Some(schema) = schema.filter(|_| channel.message_encoding == "cdr") else {
            let schema = channel.schema.as_ref().map_or("none", |schema| schema.encoding.as_str());
            let found = format!("messages in `{}` with a schema in `{schema}`", channel.message_encoding);
            let remedy = "record with rosbag2 (`ros2 bag record -s mcap`), or convert the bag";
            return Err(wrong(found, "messages in `cdr` with a schema in `ros2msg`", remedy));
        };
        let text = String::from_utf8_lossy(&schema.data);
        let definitions = Definitions::parse(&schema.name, &text)
            .map_err(|error| wrong(error.to_string(), "a definition of ROS 2", "is the file from another tool?"))?;
        let layout = if fields.is_empty() {
            let known = format!("one of {}", KNOWN.join(", "));
            let remedy = "name the fields: `--field x=PATH --field y=PATH --field z=PATH`";
            Layout::of(&kind).ok_or_else(|| wrong(format!("messages of the type {kind}"), &known, remedy))?
        } else {
            Layout::by_fields(fields).map_err(|name| RowError::field(path, &topic, &name))?
        };
        Ok(Self { path, topic, kind, definitions, layout })
    }

    fn decode(&self, data: &[u8], number: usize) -> Result<Value, LogError> {
        Value::decode(data, &self.definitions).map_err(|error| {
            let expected = format!("a message of the type {}", self.kind);
            let remedy = "the file is damaged, or its definition is not that of its messages";
            not_understood(self.path, &self.place(number), &error.to_string(), &expected, remedy)
        })
    }

    /// Messages of one topic in two frames.
    fn mixed(&self, number: usize, found: &str, first: &str) -> LogError {
        let remedy = "record the topics of different frames apart, or transform them to one frame";
        not_understood(self.path, &self.place(number), found, &format!("as in the first message: {first}"), remedy)
    }

    fn place(&self, number: usize) -> String {
        format!("{}, message {number}", self.topic)
    }

    fn rows(&self, value: &Value, log_ns: i128, number: usize) -> Result<Vec<Row>, LogError> {
        let rows = self.layout.rows(value, log_ns);
        rows.map_err(|error| error.at(self.path, &self.place(number), &self.kind, value))
    }
}
