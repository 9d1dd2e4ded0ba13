//! The text of a generated scenario file, with comments for a reader who edits it.

use std::fmt::Write;

use scenarios::{BoxObstacle, Cylinder, MovingCylinder, Range, Vehicle, Waypoint, World};

use super::Request;

/// Content of a file, apart from what every file says about its origin.
pub struct Draft {
    /// What happens in it, in one sentence without a full stop.
    pub summary: String,
    /// Why the problem can be solved: full sentences.
    pub certificate: String,
    /// Words for selecting it.
    pub tags: Vec<&'static str>,
    /// Map and obstacles.
    pub world: World,
    /// The tables of the models.
    pub models: String,
    /// The table `[fleet]`; empty if there is none.
    pub fleet: String,
    /// The vehicles.
    pub vehicles: Vec<Vehicle>,
    /// The tables from `[planner]` to the end.
    pub settings: String,
}

/// Width of comment lines.
const WIDTH: usize = 118;

/// The file.
pub fn text(request: &Request, draft: &Draft) -> String {
    let mut text = String::new();
    let origin = format!("Written by harness {}: {}", env!("CARGO_PKG_VERSION"), request.command());
    for paragraph in [origin.as_str(), request.kind.summary, &format!("It can be solved: {}", draft.certificate)] {
        text.push_str(&comment(paragraph));
    }
    let Draft { summary, tags, .. } = draft;
    let Request { kind, size, density, seed, .. } = request;
    let variant = request.variant().map_or_else(String::new, |variant| format!(", {}", variant.name()));
    let tags: Vec<String> = tags.iter().chain([&"generated", &kind.name]).map(|tag| format!("{tag:?}")).collect();
    put(
        &mut text,
        format_args!(
            "\nname = \"{}\"\ndescription = \"{summary}. Generated: kind {}{variant}, size {size}, density {density}, seed {seed}.\"\n\
             tags = [{}]\n",
            request.name(),
            kind.name,
            tags.join(", ")
        ),
    );
    text.push_str(&world(&draft.world));
    text.push_str(&draft.models);
    text.push_str(&draft.fleet);
    draft.vehicles.iter().for_each(|each| text.push_str(&vehicle(each)));
    text.push_str(&draft.settings);
    text
}

fn put(text: &mut String, what: std::fmt::Arguments<'_>) {
    text.write_fmt(what).expect("writing to a string cannot fail");
}

/// Comment lines of at most [`WIDTH`] characters.
fn comment(paragraph: &str) -> String {
    let mut lines = vec![String::from("#")];
    for word in paragraph.split(' ') {
        let line = lines.last_mut().expect("there is a first line");
        if line.len() + 1 + word.len() > WIDTH {
            lines.push(format!("# {word}"));
        } else {
            line.push(' ');
            line.push_str(word);
        }
    }
    lines.join("\n") + "\n"
}

fn world(world: &World) -> String {
    let mut text = String::from("\n[world]\n");
    if !world.hidden.is_empty() {
        let names: Vec<String> = world.hidden.iter().map(|name| format!("{name:?}")).collect();
        put(&mut text, format_args!("hidden = [{}] # not known before they are sensed\n", names.join(", ")));
    }
    if let Some(ground_m) = world.ground_m {
        put(&mut text, format_args!("ground_m = {ground_m}\n"));
    }
    let [x, y, z] = world.map.axes().map(range);
    put(&mut text, format_args!("\n[world.map]\nx_m = {x}\ny_m = {y}\nz_m = {z}\n"));
    world.cylinders.iter().for_each(|each| text.push_str(&cylinder(each)));
    world.boxes.iter().for_each(|each| text.push_str(&block(each)));
    world.moving.iter().for_each(|each| text.push_str(&moving(each)));
    for gate in &world.gates {
        put(&mut text, format_args!("\n[[world.gates]]\nname = \"{}\"\n", gate.name));
        for (whose, window) in [("quadrotor", &gate.quadrotor), ("load", &gate.load)] {
            let axes: Vec<String> = ["x_m", "y_m", "z_m"]
                .iter()
                .zip(window.axes())
                .filter_map(|(axis, faces)| Some(format!("{axis} = {}", range(faces?))))
                .collect();
            put(&mut text, format_args!("{whose} = {{ {} }}\n", axes.join(", ")));
        }
    }
    text
}

fn range(Range { min, max }: Range) -> String {
    format!("[{min}, {max}]")
}

fn cylinder(Cylinder { name, center_m: [x, y], radius_m }: &Cylinder) -> String {
    format!("\n[[world.cylinders]]\nname = \"{name}\"\ncenter_m = [{x}, {y}]\nradius_m = {radius_m}\n")
}

fn block(block: &BoxObstacle) -> String {
    let ([x, y], [length, width]) = (block.center_m, block.size_m);
    let mut text =
        format!("\n[[world.boxes]]\nname = \"{}\"\ncenter_m = [{x}, {y}]\nsize_m = [{length}, {width}]\n", block.name);
    if block.heading_deg != 0.0 {
        put(&mut text, format_args!("heading_deg = {}\n", block.heading_deg));
    }
    if let Some(z_m) = block.z_m {
        put(&mut text, format_args!("z_m = {}\n", range(z_m)));
    }
    text
}

fn moving(moving: &MovingCylinder) -> String {
    let corners: Vec<String> = moving.path_m.iter().map(|[x, y]| format!("[{x}, {y}]")).collect();
    format!(
        "\n[[world.moving]]\nname = \"{}\"\nradius_m = {}\npath_m = [{}]\nspeed_mps = {}\noffset_m = {}\n",
        moving.name,
        moving.radius_m,
        corners.join(", "),
        moving.speed_mps,
        moving.offset_m
    )
}

fn vehicle(Vehicle { name, model, start, goal, via: _ }: &Vehicle) -> String {
    let (start, goal) = (waypoint(start), waypoint(goal));
    format!("\n[[vehicles]]\nname = \"{name}\"\nmodel = \"{model}\"\nstart = {start}\ngoal = {goal}\n")
}

fn waypoint(point: &Waypoint) -> String {
    let [x, y, z] = point.position_m();
    let mut text = format!("{{ x_m = {x}, y_m = {y}, z_m = {z}");
    if point.speed_mps != 0.0 {
        put(&mut text, format_args!(", speed_mps = {}, heading_deg = {}", point.speed_mps, point.heading_deg));
    }
    if let Some(load) = point.load {
        let [x, y, z] = load.position_m();
        put(&mut text, format_args!(", load = {{ x_m = {x}, y_m = {y}, z_m = {z} }}"));
    }
    text + " }"
}
