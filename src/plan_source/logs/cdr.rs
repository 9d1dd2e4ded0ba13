//! Values of messages in the Common Data Representation of DDS, by their [definitions](Definitions).
//!
//! A message begins with four bytes that name the representation; every number is aligned to its size, counted from behind
//! them. [OMG DDS-XTypes 1.3, 7.4]

use thiserror::Error;

use super::ros2msg::{Count, Definitions, Element, Field, Number};

/// Largest depth of messages in messages.
const MAX_DEPTH: usize = 32;
/// Values that a message may have beyond its number of bytes: those without a byte of their own.
const SPARE_VALUES: usize = 10_000;

/// A value of a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// Several values.
    List(Vec<Value>),
    /// The fields of a message, in their order.
    Message(Vec<(String, Value)>),
}

/// Why a message cannot be decoded.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CdrError {
    /// The representation is not one that ROS 2 uses.
    #[error("the representation {0:#06x} is not plain CDR")]
    Representation(u16),
    /// There are fewer bytes than the definition asks for.
    #[error("the message ends before its field `{0}` does")]
    Short(String),
    /// A type is not defined.
    #[error("the file has no definition of {0}")]
    Undefined(String),
    /// Messages hold each other too deeply, or too many values.
    #[error("the definition of {0} holds too many values")]
    TooMany(String),
}

impl Value {
    /// Decodes a message.
    ///
    /// # Errors
    ///
    /// The bytes are not a message of this type.
    pub fn decode(data: &[u8], definitions: &Definitions) -> Result<Self, CdrError> {
        let [first, second, _, _] = *data.first_chunk::<4>().ok_or_else(|| CdrError::Short("header".into()))?;
        let (is_little, max_alignment) = match u16::from_be_bytes([first, second]) {
            0 => (false, 8),
            1 => (true, 8),
            6 => (false, 4),
            7 => (true, 4),
            other => return Err(CdrError::Representation(other)),
        };
        let body = &data[4..];
        let mut reader = Reader { body, at: 0, is_little, max_alignment, left: body.len() + SPARE_VALUES };
        reader.message(definitions, &definitions.root, 0)
    }

    /// Decodes a message whose little-endian numbers are packed, without a header and without alignment.
    ///
    /// # Errors
    ///
    /// The bytes are not a message of this type.
    pub fn decode_packed(data: &[u8], definitions: &Definitions) -> Result<Self, CdrError> {
        let mut reader =
            Reader { body: data, at: 0, is_little: true, max_alignment: 1, left: data.len() + SPARE_VALUES };
        reader.message(definitions, &definitions.root, 0)
    }

    /// The value at a path: `pose.position.x`, `position[2]`.
    pub fn at(&self, path: &str) -> Option<&Self> {
        path.split(['.', '[']).try_fold(self, |value, step| match (value, step.strip_suffix(']')) {
            (Self::Message(fields), None) => Some(&fields.iter().find(|(name, _)| name == step)?.1),
            (Self::List(values), Some(index)) => values.get(index.parse::<usize>().ok()?),
            _ => None,
        })
    }

    /// The number at a path.
    pub fn number(&self, path: &str) -> Option<f64> {
        match self.at(path)? {
            Self::Number(number) => Some(*number),
            Self::Text(_) | Self::List(_) | Self::Message(_) => None,
        }
    }

    /// The text at a path.
    pub fn text(&self, path: &str) -> Option<&str> {
        match self.at(path)? {
            Self::Text(text) => Some(text),
            Self::Number(_) | Self::List(_) | Self::Message(_) => None,
        }
    }

    /// The paths of all numbers, for people.
    pub fn number_paths(&self) -> Vec<String> {
        match self {
            Self::Number(_) => vec![String::new()],
            Self::Text(_) => Vec::new(),
            Self::List(values) => {
                let first = values.first().map(Self::number_paths).unwrap_or_default();
                first.into_iter().map(|rest| format!("[0]{rest}")).collect()
            }
            Self::Message(fields) => {
                let of = |(name, value): &(String, Self)| {
                    let paths = value.number_paths().into_iter();
                    paths.map(|rest| format!(".{name}{rest}")).collect::<Vec<_>>()
                };
                fields.iter().flat_map(of).collect()
            }
        }
    }
}

struct Reader<'a> {
    body: &'a [u8],
    at: usize,
    is_little: bool,
    max_alignment: usize,
    /// Values that may still be made.
    left: usize,
}

impl Reader<'_> {
    fn message(&mut self, definitions: &Definitions, name: &str, depth: usize) -> Result<Value, CdrError> {
        if depth > MAX_DEPTH {
            return Err(CdrError::TooMany(name.to_owned()));
        }
        let fields = definitions.fields(name).ok_or_else(|| CdrError::Undefined(name.to_owned()))?;
        let mut values = Vec::with_capacity(fields.len());
        for field in fields {
            values.push((field.name.clone(), self.field(definitions, field, depth)?));
        }
        Ok(Value::Message(values))
    }

    fn field(&mut self, definitions: &Definitions, field: &Field, depth: usize) -> Result<Value, CdrError> {
        let count = match field.count {
            Count::One => return self.element(definitions, field, depth),
            Count::Fixed(count) => count,
            Count::Sequence => self.length(&field.name)?,
        };
        // An element without a byte is no reason for a list longer than the message.
        if count > self.body.len() - self.at {
            return Err(CdrError::Short(field.name.clone()));
        }
        let elements = (0..count).map(|_| self.element(definitions, field, depth));
        Ok(Value::List(elements.collect::<Result<_, _>>()?))
    }

    fn element(&mut self, definitions: &Definitions, field: &Field, depth: usize) -> Result<Value, CdrError> {
        self.left = self.left.checked_sub(1).ok_or_else(|| CdrError::TooMany(field.name.clone()))?;
        match &field.element {
            Element::Number(number) => Ok(Value::Number(self.number(*number, &field.name)?)),
            Element::Message(name) => self.message(definitions, name, depth + 1),
            Element::Text => {
                let length = self.length(&field.name)?;
                let bytes = self.bytes(length, &field.name)?;
                let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
                Ok(Value::Text(String::from_utf8_lossy(text).into_owned()))
            }
        }
    }

    fn length(&mut self, field: &str) -> Result<usize, CdrError> {
        Ok(self.number(Number::Unsigned(4), field)? as usize)
    }

    fn number(&mut self, number: Number, field: &str) -> Result<f64, CdrError> {
        let (Number::Unsigned(size) | Number::Signed(size) | Number::Float(size)) = number;
        self.at = self.at.next_multiple_of(size.min(self.max_alignment));
        let is_little = self.is_little;
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(self.bytes(size, field)?);
        if !is_little {
            bytes[..size].reverse();
        }
        let bits = u64::from_le_bytes(bytes);
        let unused = 64 - 8 * size as u32;
        Ok(match number {
            Number::Unsigned(_) => bits as f64,
            Number::Signed(_) => ((bits << unused) as i64 >> unused) as f64,
            Number::Float(4) => f64::from(f32::from_bits(bits as u32)),
            Number::Float(_) => f64::from_bits(bits),
        })
    }

    fn bytes(&mut self, count: usize, field: &str) -> Result<&[u8], CdrError> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.body.len());
        let end = end.ok_or_else(|| CdrError::Short(field.to_owned()))?;
        let bytes = &self.body[self.at..end];
        self.at = end;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::{CdrError, Value};
    use crate::plan_source::logs::ros2msg::Definitions;

    fn definitions(text: &str) -> Definitions {
        Definitions::parse("a/B", text).unwrap()
    }

    #[test]
    fn numbers_are_aligned_to_their_size() {
        let all = definitions("int8 a\nfloat64 b\nstring c\nfloat32[] d\nint16 e");
        let mut data = vec![0, 1, 0, 0, 0xff, 0, 0, 0, 0, 0, 0, 0];
        data.extend(1.5_f64.to_le_bytes());
        data.extend([3, 0, 0, 0, b'h', b'i', 0, 0, 1, 0, 0, 0]);
        data.extend(2.5_f32.to_le_bytes());
        data.extend((-2_i16).to_le_bytes());
        let value = Value::decode(&data, &all).unwrap();
        let numbers = ["a", "b", "d[0]", "e"].map(|path| value.number(path).unwrap());
        assert_eq!((numbers, value.text("c")), ([-1.0, 1.5, 2.5, -2.0], Some("hi")));
        assert_eq!(value.number_paths(), [".a", ".b", ".d[0]", ".e"]);
        assert!(value.number("c").is_none() && value.at("d[1]").is_none() && value.at("d.x").is_none());
        // Every shorter message ends within a field.
        for length in 0..data.len() {
            assert!(matches!(Value::decode(&data[..length], &all), Err(CdrError::Short(_))), "{length}");
        }
    }

    #[test]
    fn big_endian_numbers_and_the_alignment_of_the_second_version_are_understood() {
        let two = definitions("int32 a\nfloat64 b");
        let mut big = vec![0, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0, 0];
        big.extend(0.5_f64.to_be_bytes());
        assert_eq!(Value::decode(&big, &two).unwrap().number("b"), Some(0.5));
        let mut second = vec![0, 7, 0, 0, 7, 0, 0, 0];
        second.extend(0.5_f64.to_le_bytes());
        assert_eq!(Value::decode(&second, &two).unwrap().number("b"), Some(0.5));
        assert_eq!(Value::decode(&[0, 3, 0, 0], &two), Err(CdrError::Representation(3)));
    }

    #[test]
    fn definitions_that_hold_each_other_or_nothing_end() {
        let data = [vec![0, 1, 0, 0], vec![0xff; 200]].concat();
        assert!(Value::decode(&data, &definitions("B b")).is_err());
        assert!(Value::decode(&data, &definitions("C c")).is_err());
        let nested = "C[190] c\n===\nMSG: a/C\nD[190] d\n===\nMSG: a/D\nE[190] e\n===\nMSG: a/E\n";
        assert!(matches!(Value::decode(&data, &definitions(nested)), Err(CdrError::TooMany(_))));
    }
}
