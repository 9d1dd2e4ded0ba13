//! The C interface of the harness, described by `include/uav_harness.h`.
//!
//! Every function catches panics, which must not cross into C.

// There is nothing to test from Rust: `cargo test --lib` finds an empty crate.
#![cfg(not(test))]

mod layout;
mod pointers;

use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use harness::guard::{Guard, Knot};
use harness::metrics;
use harness::plan_source::plan_import;
use harness::plan_source::{Flown, PlanSource};
use harness::report::{Report, Timings};
use harness::verdict::Outcome;
use scenarios::plan_input;

use layout::{Assessment, CKnot, FAIL, INVALID, PASS};

/// A guard and its memory for knots.
pub struct CGuard {
    guard: Guard,
    knots: Vec<Knot>,
}

/// What went wrong, for the error text.
type Outcomes<T> = Result<T, String>;

/// See the header.
///
/// # Safety
///
/// Texts end with a zero byte, and `error` has room for `error_size` bytes.
#[expect(unsafe_code, reason = "exported to C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uav_harness_guard_new(
    scenario: *const c_char,
    vehicle: *const c_char,
    error: *mut c_char,
    error_size: usize,
) -> *mut CGuard {
    let (scenario, vehicle) = (pointers::text(scenario), pointers::text(vehicle));
    let made = guarded(|| {
        let guard = Guard::new(&load(&scenario?)?, &vehicle?).map_err(|error| error.to_string())?;
        Ok(CGuard { guard, knots: Vec::new() })
    });
    match made {
        Ok(guard) => Box::into_raw(Box::new(guard)),
        Err(reason) => {
            pointers::write_text(error, error_size, &reason);
            std::ptr::null_mut()
        }
    }
}

/// See the header.
///
/// # Safety
///
/// As for [`uav_harness_guard_new`]; `guard` is a guard.
#[expect(unsafe_code, reason = "exported to C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uav_harness_guard_set_world(
    guard: *mut CGuard,
    scenario: *const c_char,
    error: *mut c_char,
    error_size: usize,
) -> i32 {
    let scenario = pointers::text(scenario);
    let set = guarded(|| {
        let guard = pointers::exclusive(guard).ok_or("guard: found null")?;
        guard.guard.set_world(&load(&scenario?)?.world);
        Ok(PASS)
    });
    set.unwrap_or_else(|reason| {
        pointers::write_text(error, error_size, &reason);
        INVALID
    })
}

/// See the header.
///
/// # Safety
///
/// `guard` is a guard, `knots` points to `count` knots, `measured` to one or to nothing, `assessment` to one.
#[expect(unsafe_code, reason = "exported to C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uav_harness_guard_judge(
    guard: *mut CGuard,
    knots: *const CKnot,
    count: usize,
    measured: *const CKnot,
    assessment: *mut Assessment,
) -> i32 {
    let judged = guarded(|| {
        let guard = pointers::exclusive(guard).ok_or("guard: found null")?;
        let assessment = pointers::exclusive(assessment).ok_or("assessment: found null")?;
        guard.knots.clear();
        guard.knots.extend(pointers::list(knots, count).iter().map(Knot::from));
        let measured = pointers::list(measured, 1).first().map(Knot::from);
        let judged = guard.guard.judge(&guard.knots, measured.as_ref());
        *assessment = Assessment::new(&guard.guard, &judged);
        Ok(assessment.status)
    });
    judged.unwrap_or(INVALID)
}

/// See the header.
///
/// # Safety
///
/// `guard` is a guard that is used no more, or null.
#[expect(unsafe_code, reason = "exported to C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uav_harness_guard_free(guard: *mut CGuard) {
    pointers::free(guard);
}

/// See the header.
///
/// # Safety
///
/// As for [`uav_harness_guard_new`]; `report` points to a pointer.
#[expect(unsafe_code, reason = "exported to C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uav_harness_check(
    scenario: *const c_char,
    plan: *const c_char,
    report: *mut *mut c_char,
    error: *mut c_char,
    error_size: usize,
) -> i32 {
    let (scenario, plan) = (pointers::text(scenario), pointers::text(plan));
    let checked = guarded(|| {
        let place = pointers::exclusive(report).ok_or("report: found null")?;
        *place = std::ptr::null_mut();
        let report = check(&scenario?, &plan?)?;
        let text = serde_json::to_string(&report).map_err(|error| error.to_string())?;
        *place = CString::new(text).map_err(|error| error.to_string())?.into_raw();
        Ok(if report.verdict == Outcome::Pass { PASS } else { FAIL })
    });
    checked.unwrap_or_else(|reason| {
        pointers::write_text(error, error_size, &reason);
        INVALID
    })
}

/// See the header.
///
/// # Safety
///
/// `text` is a report of [`uav_harness_check`] that is used no more, or null.
#[expect(unsafe_code, reason = "exported to C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn uav_harness_text_free(text: *mut c_char) {
    pointers::free_text(text);
}

fn load(path: &str) -> Outcomes<scenarios::Scenario> {
    scenarios::load(Path::new(path)).map_err(|error| error.lines().join("\n"))
}

fn check(scenario: &str, plan: &str) -> Outcomes<Report> {
    let scenario = load(scenario)?;
    let path = Path::new(plan);
    let (header, tracks) = plan_input::read(path, &scenario).map_err(|error| error.lines().join("\n"))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let seed = scenario.simulation.seed;
    let completed = plan_import::complete(&scenario, header, tracks, &name, seed);
    let flown = PlanSource::Imported(Box::new(completed)).fly(&scenario, seed);
    let verdict = flown.judge(&scenario);
    let Flown { answer, flight } = &flown;
    let metrics = metrics::measure(&scenario, &answer.plan, flight.as_ref());
    Ok(Report::new(answer, flight.as_ref(), verdict, metrics, Timings::default()))
}

/// The result of `work`; a panic is an error.
fn guarded<T>(work: impl FnOnce() -> Outcomes<T>) -> Outcomes<T> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err("a bug of the harness: it panicked".to_owned()))
}
