//! The structures of the header, field by field.

use harness::guard::{self, Guard, Knot};
use harness::verdict::Status;

/// Answers of the header.
pub const PASS: i32 = 0;
/// A limit is broken.
pub const FAIL: i32 = 1;
const UNDECIDED: i32 = 2;
const SKIP: i32 = 3;
/// Bad input, or a bug.
pub const INVALID: i32 = -1;

const CHECKS: usize = 6;

/// `uav_harness_knot`.
#[repr(C)]
pub struct CKnot {
    /// Time, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: [f64; 3],
    /// Velocity, m/s.
    pub velocity_mps: [f64; 3],
}

impl From<&CKnot> for Knot {
    fn from(knot: &CKnot) -> Self {
        Self { t_s: knot.t_s, position_m: knot.position_m, velocity_mps: knot.velocity_mps }
    }
}

/// `uav_harness_margin`.
#[repr(C)]
pub struct Margin {
    /// What was found.
    pub value: f64,
    /// What it is held against.
    pub limit: f64,
    /// Distance to the limit.
    pub margin: f64,
    /// When, s.
    pub at_s: f64,
    /// The answer.
    pub status: i32,
    /// Name of the check.
    pub check: [u8; 28],
    /// Unit of the three.
    pub unit: [u8; 16],
    /// The obstacle, or the limited quantity.
    pub of: [u8; 64],
}

/// `uav_harness_assessment`.
#[repr(C)]
pub struct Assessment {
    /// The answer as a whole.
    pub status: i32,
    /// Number of checks.
    pub checks: i32,
    /// The checks.
    pub margins: [Margin; CHECKS],
}

impl Assessment {
    /// What `guard` said.
    pub fn new(guard: &Guard, judged: &guard::Assessment) -> Self {
        let margins = judged.margins.each_ref().map(|margin| Margin::new(guard, margin));
        Self { status: number(judged.status), checks: CHECKS as i32, margins }
    }
}

impl Margin {
    fn new(guard: &Guard, made: &guard::Margin) -> Self {
        let of = match made.check {
            "plan.clearance" if made.value.is_finite() => guard.obstacle_name(made.obstacle),
            _ => made.quantity.unwrap_or(""),
        };
        Self {
            value: made.value,
            limit: made.limit,
            margin: made.margin,
            at_s: made.at_s,
            status: number(made.status),
            check: bytes(made.check),
            unit: bytes(made.unit),
            of: bytes(of),
        }
    }
}

fn number(status: Status) -> i32 {
    match status {
        Status::Pass => PASS,
        Status::Fail => FAIL,
        Status::Undecided => UNDECIDED,
        Status::Skip => SKIP,
    }
}

/// The text, cut to fit, with a zero byte at its end.
fn bytes<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    let length = text.floor_char_boundary(N - 1);
    bytes[..length].copy_from_slice(&text.as_bytes()[..length]);
    bytes
}
