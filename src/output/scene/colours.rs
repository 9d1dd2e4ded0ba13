//! Colours. Red is reserved for obstacles, limits and violations; no vehicle is red.

/// Obstacles.
pub const OBSTACLE: [u8; 3] = [205, 75, 65];
/// Limits in plots.
pub const LIMIT: [u8; 3] = [225, 70, 60];
/// Series of the whole fleet.
pub const FLEET: [u8; 3] = [95, 165, 245];
/// Map outline and its labels.
pub const MAP: [u8; 3] = [120, 128, 140];
/// Ground grid.
pub const GRID: [u8; 3] = [58, 64, 74];
/// Background of the world.
pub const SKY: [u8; 3] = [16, 18, 24];
/// A limit that was kept; gates.
pub const KEPT: [u8; 3] = [80, 200, 120];
/// Obstacles that no vehicle knows of yet.
pub const UNKNOWN: [u8; 3] = [120, 100, 190];
/// Obstacles that move.
pub const MOVING: [u8; 3] = [235, 140, 60];
/// A slung load.
pub const LOAD: [u8; 3] = [245, 190, 70];
/// A slack cable.
pub const SLACK: [u8; 3] = [150, 155, 165];
/// The flight of an earlier run.
pub const GHOST: [u8; 3] = [165, 170, 180];
/// Arrows of the wind.
pub const WIND: [u8; 3] = [150, 200, 235];
/// A plan flown open loop.
pub const OPEN_LOOP: [u8; 3] = [225, 120, 210];
/// The edges of a planner's cost map.
pub const COST_MAP: [u8; 3] = [62, 84, 104];

/// Brightness of a dimmed colour relative to the full one.
const DIMMED_BRIGHTNESS: f64 = 0.5;
/// Range of the vehicles' hues, deg: without red, around 0.
const FIRST_HUE_DEG: f64 = 28.0;
const LAST_HUE_DEG: f64 = 325.0;

/// Colour of vehicle `index` of `count`: equally spaced hues, with alternating brightness so that neighbours differ.
pub fn vehicle(index: usize, count: usize) -> [u8; 3] {
    let hue_deg = FIRST_HUE_DEG + (LAST_HUE_DEG - FIRST_HUE_DEG) * index as f64 / count.max(2).saturating_sub(1) as f64;
    let lightness = if index.is_multiple_of(2) { 0.62 } else { 0.52 };
    rgb_from_hsl(hue_deg, 0.85, lightness)
}

/// Colour of terrain at a fraction of its range of heights: from dark green to the grey of rock.
pub fn terrain(fraction: f64) -> [u8; 3] {
    let (low, high) = ([58.0, 84.0, 62.0], [196.0, 190.0, 176.0]);
    std::array::from_fn(|channel| (low[channel] + fraction * (high[channel] - low[channel])) as u8)
}

/// The dimmed variant of a colour: planned paths, starts.
pub fn dimmed(colour: [u8; 3]) -> [u8; 3] {
    colour.map(|channel| (f64::from(channel) * DIMMED_BRIGHTNESS) as u8)
}

/// Hue in deg, saturation and lightness in [0, 1]. Channel n of (0, 8, 4) is L - a max(-1, min(k - 3, 9 - k, 1)) with
/// k = (n + H/30) mod 12 and a = S min(L, 1 - L).
fn rgb_from_hsl(hue_deg: f64, saturation: f64, lightness: f64) -> [u8; 3] {
    let a = saturation * lightness.min(1.0 - lightness);
    [0.0, 8.0, 4.0].map(|n| {
        let k = (n + hue_deg / 30.0) % 12.0;
        (255.0 * (lightness - a * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0))).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::{rgb_from_hsl, vehicle};

    #[test]
    fn primary_hues_give_primary_colours() {
        assert_eq!(rgb_from_hsl(0.0, 1.0, 0.5), [255, 0, 0]);
        assert_eq!(rgb_from_hsl(120.0, 1.0, 0.5), [0, 255, 0]);
        assert_eq!(rgb_from_hsl(240.0, 1.0, 0.5), [0, 0, 255]);
    }

    #[test]
    fn no_vehicle_is_red_and_seven_vehicles_are_distinct() {
        for count in [1, 2, 7, 100] {
            for [r, g, b] in (0..count).map(|index| vehicle(index, count)) {
                assert!(g.abs_diff(b) > 40 || r < g.max(b), "({r}, {g}, {b}) of {count} is red");
            }
        }
        let colours: Vec<_> = (0..7).map(|index| vehicle(index, 7)).collect();
        for (i, a) in colours.iter().enumerate() {
            for b in &colours[..i] {
                let difference: u32 = (0..3).map(|c| u32::from(a[c].abs_diff(b[c]))).sum();
                assert!(difference > 60, "{a:?} and {b:?}");
            }
        }
    }
}
