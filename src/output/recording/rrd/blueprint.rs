//! A layout written entity by entity: rerun's builders lack camera, axis ranges and play state.
//!
//! The entities are those that `re_sdk::blueprint` writes.

use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes as archetype;
use rerun::external::re_sdk_types::blueprint::components as component;
use rerun::external::re_sdk_types::components::Range1D;
use rerun::external::re_sdk_types::datatypes::{AbsoluteTimeRange, Float32, TimeInt, TimeRange, TimeRangeBoundary};
use rerun::log::LogMsg;
use rerun::sink::MemorySinkStorage;
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder};
use uuid::Uuid;

use super::{APPLICATION, Logged, SIM_TIME};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Kinds of views.
#[derive(Clone, Copy, Debug)]
pub enum ViewClass {
    /// Space.
    Spatial3D,
    /// A drawing.
    Spatial2D,
    /// Scalars over time.
    TimeSeries,
    /// A text log.
    TextLog,
    /// A document.
    TextDocument,
}

impl ViewClass {
    fn identifier(self) -> &'static str {
        match self {
            Self::Spatial3D => "3D",
            Self::Spatial2D => "2D",
            Self::TimeSeries => "TimeSeries",
            Self::TextLog => "TextLog",
            Self::TextDocument => "TextDocument",
        }
    }
}

/// A view or a container, for its parent to refer to.
#[derive(Clone, Debug)]
pub struct Part {
    path: String,
    id: Uuid,
}

/// How a recording plays.
#[derive(Clone, Copy, Debug)]
pub struct Playback {
    /// Relative to real time.
    pub speed: f64,
    /// The part that is played, s; `None`: the whole recording.
    pub window_s: Option<[f64; 2]>,
}

/// A layout under construction.
pub struct Blueprint {
    stream: RecordingStream,
    messages: MemorySinkStorage,
    parts: std::cell::Cell<u128>,
}

impl Blueprint {
    /// An empty layout.
    pub fn new() -> Result<Self, Error> {
        let builder = RecordingStreamBuilder::new(APPLICATION).enabled(true).recording_id("layout").blueprint();
        let (stream, messages) = builder.memory()?;
        stream.set_log_time_enabled(false);
        stream.set_log_tick_enabled(false);
        stream.set_time_sequence("blueprint", 0);
        Ok(Self { stream, messages, parts: 0.into() })
    }

    /// A view of `contents` (query expressions) below `origin`.
    pub fn view(&self, class: ViewClass, name: &str, origin: &str, contents: &[String]) -> Result<Part, Error> {
        let part = self.part("view");
        let queries = contents.iter().map(|query| component::QueryExpression(query.as_str().into()));
        self.stream.log(format!("{}/ViewContents", part.path), &archetype::ViewContents::new(queries))?;
        let view = archetype::ViewBlueprint::new(component::ViewClass(class.identifier().into()));
        self.stream.log(part.path.as_str(), &view.with_display_name(name).with_space_origin(origin))?;
        Ok(part)
    }

    /// Sets a property of a view; `name` is that of the archetype.
    pub fn property(&self, view: &Part, name: &str, value: &dyn AsComponents) -> Logged {
        Ok(self.stream.log(format!("{}/{name}", view.path), value)?)
    }

    /// Fixes the vertical axis of a time series view.
    pub fn values(&self, view: &Part, min: f64, max: f64) -> Logged {
        self.property(view, "ScalarAxis", &archetype::ScalarAxis::new().with_range(Range1D::new(min, max)))
    }

    /// Fixes the horizontal axis of a time series view, s: otherwise a playing viewer shows only a few seconds.
    pub fn times(&self, view: &Part, start_s: f64, end_s: f64) -> Logged {
        let [start, end] = [start_s, end_s].map(|t_s| TimeRangeBoundary::Absolute(((1e9 * t_s) as i64).into()));
        let range = component::TimeRange(TimeRange { start, end });
        self.property(view, "TimeAxis", &archetype::TimeAxis::new().with_view_range(range))
    }

    /// Parts above each other, with their relative heights.
    pub fn rows(&self, name: &str, parts: &[(Part, f32)]) -> Result<Part, Error> {
        let shares = parts.iter().map(|(_, share)| component::RowShare(Float32(*share)));
        let kind = archetype::ContainerBlueprint::new(component::ContainerKind::Vertical).with_row_shares(shares);
        self.container(kind, name, &parts.iter().map(|(part, _)| part.clone()).collect::<Vec<_>>())
    }

    /// Parts side by side, with their relative widths.
    pub fn columns(&self, name: &str, parts: &[(Part, f32)]) -> Result<Part, Error> {
        let shares = parts.iter().map(|(_, share)| component::ColumnShare(Float32(*share)));
        let kind = archetype::ContainerBlueprint::new(component::ContainerKind::Horizontal).with_col_shares(shares);
        self.container(kind, name, &parts.iter().map(|(part, _)| part.clone()).collect::<Vec<_>>())
    }

    /// Parts as tabs; the first is active.
    pub fn tabs(&self, name: &str, parts: &[Part]) -> Result<Part, Error> {
        let mut kind = archetype::ContainerBlueprint::new(component::ContainerKind::Tabs);
        if let Some(first) = parts.first() {
            kind = kind.with_active_tab(first.path.as_str());
        }
        self.container(kind, name, parts)
    }

    /// Makes `root` the whole window and sends the layout with the recording `to`, which plays in a loop.
    pub fn send(self, root: &Part, playback: &Playback, to: &RecordingStream) -> Logged {
        let viewport = archetype::ViewportBlueprint::new()
            .with_root_container(component::RootContainer(root.id.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.stream.log("viewport", &viewport)?;
        let time_panel = archetype::TimePanelBlueprint::new()
            .with_timeline(SIM_TIME)
            .with_state(component::PanelState::Collapsed)
            .with_playback_speed(playback.speed)
            .with_play_state(component::PlayState::Playing);
        let time_panel = match playback.window_s {
            None => time_panel.with_loop_mode(component::LoopMode::All),
            Some(window_s) => {
                let [min, max] = window_s.map(|t_s| TimeInt::from((1e9 * t_s) as i64));
                let window = component::AbsoluteTimeRange(AbsoluteTimeRange { min, max });
                time_panel.with_loop_mode(component::LoopMode::Selection).with_time_selection(window)
            }
        };
        self.stream.log("time_panel", &time_panel)?;
        let hidden = archetype::PanelBlueprint::new().with_state(component::PanelState::Hidden);
        self.stream.log("selection_panel", &hidden)?;
        self.stream.log("blueprint_panel", &hidden)?;
        let Some(blueprint_id) = self.stream.store_info().map(|info| info.store_id) else { return Ok(()) };
        let messages: Vec<LogMsg> = self.messages.take();
        to.send_blueprint(messages, BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true });
        Ok(())
    }

    fn container(&self, kind: archetype::ContainerBlueprint, name: &str, parts: &[Part]) -> Result<Part, Error> {
        let part = self.part("container");
        let contents = parts.iter().map(|part| component::IncludedContent(part.path.as_str().into()));
        self.stream.log(part.path.as_str(), &kind.with_display_name(name).with_contents(contents))?;
        Ok(part)
    }

    /// The next part. Ids count up, so that equal layouts have equal ids.
    fn part(&self, kind: &str) -> Part {
        self.parts.set(self.parts.get() + 1);
        let id = Uuid::from_u128(self.parts.get());
        Part { path: format!("{kind}/{id}"), id }
    }
}
