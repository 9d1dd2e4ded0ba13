//! Protobuf messages whose fields are known only at run time: schema and encoding by hand.
//!
//! The wire format is that of [protobuf.dev, Encoding]; the schema is a `google.protobuf.FileDescriptorSet`.

use foxglove::Schema;

/// Types of fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldType {
    /// `double`.
    Double,
    /// `bool`.
    Bool,
}

/// Wire types.
const VARINT: u64 = 0;
const FIXED_64: u64 = 1;
const LENGTH_DELIMITED: u64 = 2;

/// The schema of a message `name` with singular fields, numbered from 1, in a package of the same name in lower case.
pub fn schema(name: &str, fields: &[(&str, FieldType)]) -> Schema {
    let package = name.to_lowercase();
    // FileDescriptorSet { file = 1 }, FileDescriptorProto { name = 1, package = 2, message_type = 4, syntax = 12 }
    let mut file = Vec::new();
    text(&mut file, 1, &format!("{package}.proto"));
    text(&mut file, 2, &package);
    bytes(&mut file, 4, &message_type(name, fields));
    text(&mut file, 12, "proto3");
    let mut set = Vec::new();
    bytes(&mut set, 1, &file);
    Schema::new(format!("{package}.{name}"), "protobuf", set)
}

/// A message with the given values, in the order of its fields. Flags are set unless their value is 0.
pub fn message(values: impl IntoIterator<Item = (FieldType, f64)>) -> Vec<u8> {
    let mut message = Vec::new();
    for (number, (kind, value)) in (1..).zip(values) {
        match kind {
            FieldType::Double => {
                tag(&mut message, number, FIXED_64);
                message.extend(value.to_le_bytes());
            }
            FieldType::Bool => {
                tag(&mut message, number, VARINT);
                message.push(u8::from(value != 0.0));
            }
        }
    }
    message
}

/// DescriptorProto { name = 1, field = 2 }.
fn message_type(name: &str, fields: &[(&str, FieldType)]) -> Vec<u8> {
    let mut descriptor = Vec::new();
    text(&mut descriptor, 1, name);
    for (number, (name, kind)) in (1..).zip(fields) {
        bytes(&mut descriptor, 2, &field(number, name, *kind));
    }
    descriptor
}

/// FieldDescriptorProto { name = 1, number = 3, label = 4, type = 5 }.
fn field(number: u64, name: &str, kind: FieldType) -> Vec<u8> {
    const LABEL_OPTIONAL: u64 = 1;
    let type_number = match kind {
        FieldType::Double => 1,
        FieldType::Bool => 8,
    };
    let mut descriptor = Vec::new();
    text(&mut descriptor, 1, name);
    for (field, value) in [(3, number), (4, LABEL_OPTIONAL), (5, type_number)] {
        tag(&mut descriptor, field, VARINT);
        varint(&mut descriptor, value);
    }
    descriptor
}

fn text(to: &mut Vec<u8>, number: u64, value: &str) {
    bytes(to, number, value.as_bytes());
}

fn bytes(to: &mut Vec<u8>, number: u64, value: &[u8]) {
    tag(to, number, LENGTH_DELIMITED);
    varint(to, value.len() as u64);
    to.extend(value);
}

fn tag(to: &mut Vec<u8>, number: u64, wire_type: u64) {
    varint(to, number << 3 | wire_type);
}

/// Seven bits at a time, the lowest first.
fn varint(to: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        to.push(value as u8 | 0x80);
        value >>= 7;
    }
    to.push(value as u8);
}

#[cfg(test)]
mod tests {
    use super::{FieldType, message, schema, varint};

    /// The example of [protobuf.dev, Encoding]: 150 is `96 01`.
    #[test]
    fn numbers_of_several_bytes_begin_with_the_lowest_bits() {
        let mut encoded = Vec::new();
        varint(&mut encoded, 150);
        assert_eq!(encoded, [0x96, 0x01]);
    }

    #[test]
    fn a_message_holds_its_values_in_the_order_of_its_fields() {
        let encoded = message([(FieldType::Double, 1.5), (FieldType::Bool, 1.0)]);
        assert_eq!(encoded, [&[0x09][..], &1.5_f64.to_le_bytes(), &[0x10, 0x01]].concat());
    }

    #[test]
    fn the_schema_names_message_and_fields() {
        let schema = schema("Aircraft", &[("n_x", FieldType::Double), ("is_saturated", FieldType::Bool)]);
        assert_eq!((schema.name.as_str(), schema.encoding.as_str()), ("aircraft.Aircraft", "protobuf"));
        let has = |text: &str| schema.data.windows(text.len()).any(|window| window == text.as_bytes());
        assert!(has("Aircraft") && has("n_x") && has("is_saturated") && has("proto3"));
    }
}
