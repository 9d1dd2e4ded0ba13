//! The lines that are exchanged with an in-loop command.

use scenarios::in_loop::{
    Decision, Neighbour, Node, Observation, ObstacleMeasurement, ReplanDiagnostics, ReplanResult, ReplanStatus,
};
use scenarios::{Cylinder, Prism};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::plan_source::external::{PlannerFault, request};

/// A message as a line.
pub fn line(message: &impl Serialize) -> Vec<u8> {
    let mut line = serde_json::to_vec(message).expect("a message has no keys but text");
    line.push(b'\n');
    line
}

/// The request for a new reference.
#[derive(Serialize)]
pub struct ReplanRequest<'a> {
    request: &'static str,
    id: u64,
    vehicle: &'a str,
    t_s: f64,
    takes_effect_s: f64,
    position_m: [f64; 3],
    velocity_mps: [f64; 3],
    acceleration_mps2: [f64; 3],
    world_from_body: [f64; 4],
    in_force: &'a [Node],
    last: &'a ReplanStatus,
    discovered: &'a [String],
    added: AddedObstacles<'a>,
    /// Everything that is known, for planners of protocol 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    known: Option<Value>,
    moving: &'a [ObstacleMeasurement],
    neighbours: &'a [Neighbour],
}

/// The static obstacles that the vehicle has discovered since its previous request.
#[derive(Serialize)]
struct AddedObstacles<'a> {
    cylinders: Vec<&'a Cylinder>,
    prisms: Vec<Prism>,
}

impl<'a> ReplanRequest<'a> {
    /// - `with_known`: whether all known obstacles are repeated
    pub fn new(id: u64, vehicle: &'a str, observation: &'a Observation<'_>, with_known: bool) -> Self {
        Self {
            request: "replan",
            id,
            vehicle,
            t_s: observation.t_s,
            takes_effect_s: observation.takes_effect_s,
            position_m: observation.position_m,
            velocity_mps: observation.velocity_mps,
            acceleration_mps2: observation.acceleration_mps2,
            world_from_body: observation.world_from_body,
            in_force: remaining(observation.in_force, observation.t_s),
            last: observation.last,
            discovered: observation.discovered,
            added: AddedObstacles::new(observation),
            known: with_known.then(|| request::world(observation.known)),
            moving: observation.moving,
            neighbours: observation.neighbours,
        }
    }
}

impl<'a> AddedObstacles<'a> {
    fn new(observation: &'a Observation<'_>) -> Self {
        let (known, discovered) = (observation.known, observation.discovered);
        if discovered.is_empty() {
            return Self { cylinders: Vec::new(), prisms: Vec::new() };
        }
        let prisms = known.prism_obstacles().into_iter();
        Self {
            cylinders: known.cylinders.iter().filter(|it| discovered.contains(&it.name)).collect(),
            prisms: prisms.filter(|it| discovered.contains(&it.name)).collect(),
        }
    }
}

/// The nodes of a reference that are not behind at `t_s`, s, and the one before them.
fn remaining(nodes: &[Node], t_s: f64) -> &[Node] {
    let ahead = nodes.partition_point(|node| node.t_s <= t_s);
    &nodes[ahead.saturating_sub(1)..]
}

/// A line of the command's standard output.
#[derive(Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one line at a time, and most are replies")]
pub enum Line {
    /// Nothing but white space.
    Blank,
    /// No JSON object.
    Stray,
    /// A JSON object: a reply, or what should be one.
    Reply {
        /// The id of the request that it replies to, if it has one.
        id: Option<u64>,
        /// The result, or why the reply is invalid.
        result: Result<ReplanResult, PlannerFault>,
    },
}

/// Nodes of a new reference, or the reason to keep the reference in force.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reply {
    id: Option<u64>,
    fly: Option<Vec<Node>>,
    keep: Option<String>,
    #[serde(default, rename = "account")]
    diagnostics: ReplanDiagnostics,
}

/// The id alone, of an invalid reply.
#[derive(Deserialize)]
struct Id {
    id: Option<u64>,
}

impl Line {
    /// Parses a line.
    pub fn parse(text: &str) -> Self {
        let text = text.trim();
        if text.is_empty() {
            return Self::Blank;
        }
        if !text.starts_with('{') {
            return Self::Stray;
        }
        match serde_json::from_str::<Reply>(text) {
            Ok(reply) => Self::Reply { id: reply.id, result: reply.result() },
            Err(error) => {
                let id = serde_json::from_str::<Id>(text).ok().and_then(|it| it.id);
                Self::Reply { id, result: Err(PlannerFault::InvalidReply(error.to_string())) }
            }
        }
    }
}

impl Reply {
    fn result(self) -> Result<ReplanResult, PlannerFault> {
        let decision = match (self.fly, self.keep) {
            (Some(nodes), None) => Decision::Fly(nodes),
            (None, Some(reason)) => Decision::Keep { reason },
            _ => return Err(PlannerFault::InvalidReply("it needs either `fly` or `keep`".into())),
        };
        Ok(ReplanResult { decision, diagnostics: self.diagnostics })
    }
}

#[cfg(test)]
mod tests {
    use scenarios::{BoxObstacle, Map, Range, World};

    use super::*;

    /// A request of a vehicle that knows a pole and a box, of which it has discovered some.
    fn request_json(discovered: &[String], with_known: bool) -> Value {
        let axis = Range::new(0.0, 20.0);
        let mut known = World::empty(Map { x_m: axis, y_m: axis, z_m: axis });
        known.cylinders.push(Cylinder { name: "pole".into(), center_m: [5.0, 5.0], radius_m: 0.5 });
        let size_m = [1.0, 1.0];
        known.boxes.push(BoxObstacle { name: "box".into(), center_m: [9.0, 9.0], size_m, heading_deg: 0.0, z_m: None });
        let observation = Observation {
            t_s: 1.0,
            takes_effect_s: 1.05,
            position_m: [1.0, 1.0, 2.0],
            velocity_mps: [0.0; 3],
            acceleration_mps2: [0.0; 3],
            world_from_body: [0.0, 0.0, 0.0, 1.0],
            in_force: &[Node::at_rest(0.0, [1.0, 1.0, 2.0])],
            last: &ReplanStatus::None,
            known: &known,
            discovered,
            moving: &[],
            neighbours: &[],
        };
        let line = line(&ReplanRequest::new(7, "uav-1", &observation, with_known));
        assert_eq!(line.iter().filter(|byte| **byte == b'\n').count(), 1);
        serde_json::from_slice(&line).expect("JSON")
    }

    #[test]
    fn a_request_holds_what_was_discovered_and_not_the_whole_map() {
        let names = |obstacles: &Value| -> Vec<String> {
            obstacles.as_array().unwrap().iter().map(|it| it["name"].as_str().unwrap().to_owned()).collect()
        };
        let request = request_json(&["box".into()], false);
        assert_eq!((&request["id"], &request["known"]), (&7.into(), &Value::Null));
        assert_eq!(names(&request["added"]["prisms"]), ["box"]);
        assert!(names(&request["added"]["cylinders"]).is_empty());
        assert_eq!(names(&request_json(&["pole".into()], false)["added"]["cylinders"]), ["pole"]);
        let known = &request_json(&[], true)["known"];
        assert_eq!((names(&known["cylinders"]), names(&known["prisms"])), (vec!["pole".into()], vec!["box".into()]));
    }

    #[test]
    fn a_reply_is_a_reference_or_a_reason_to_keep_the_last() {
        let fly = r#"{"id": 7, "fly": [{"t_s": 1.0, "position_m": [0, 0, 1], "velocity_mps": [0, 0, 0]}]}"#;
        let nodes = vec![Node::at_rest(1.0, [0.0, 0.0, 1.0])];
        assert_eq!(Line::parse(fly), Line::Reply { id: Some(7), result: Ok(ReplanResult::fly(nodes)) });
        let keep = Line::Reply { id: None, result: Ok(ReplanResult::keep("nothing better")) };
        assert_eq!(Line::parse("{\"keep\": \"nothing better\"}\r\n"), keep);
    }

    #[test]
    fn an_object_that_is_no_reply_is_invalid_and_keeps_its_id() {
        let texts = [
            r#"{"id": 3}"#,
            r#"{"id": 3, "fly": 3}"#,
            r#"{"id": 3, "fly": [], "keep": "both"}"#,
            r#"{"id": 3, "keep": "once", "keep": "twice"}"#,
            r#"{"id": 3, "path": []}"#,
        ];
        for text in texts {
            assert!(matches!(Line::parse(text), Line::Reply { id: Some(3), result: Err(_) }), "{text}");
        }
        for text in ["{", r#"{"id": 1, "id": 2, "keep": ""}"#, r#"{"id": -1, "keep": ""}"#] {
            assert!(matches!(Line::parse(text), Line::Reply { id: None, result: Err(_) }), "{text}");
        }
    }

    #[test]
    fn what_is_no_object_is_stray() {
        for text in ["[INFO] ready", "[]", "3", "null"] {
            assert_eq!(Line::parse(text), Line::Stray, "{text}");
        }
        assert_eq!(Line::parse(" \r\n"), Line::Blank);
    }

    #[test]
    fn nodes_behind_are_left_out() {
        let nodes = [0.0, 1.0, 2.0].map(|t_s| Node::at_rest(t_s, [0.0; 3]));
        assert_eq!(remaining(&nodes, 1.5), &nodes[1..]);
        assert_eq!(remaining(&nodes, 1.0), &nodes[1..]);
        assert_eq!(remaining(&nodes, 9.0), &nodes[2..]);
        assert_eq!(remaining(&nodes, -1.0), &nodes);
        assert!(remaining(&[], 0.0).is_empty());
    }
}
