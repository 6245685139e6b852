//! `solid check`: a scene, played and tested frame by frame.

mod bodies;
mod clock;
mod crowd;
mod files;
mod motion;
mod player;
mod presence;
mod report;
mod root_paths;
mod stage;
mod timeline;

use std::io::{IsTerminal, Write};

use anyhow::{Context, Result};
use solid_scene::{Format, Scene};
use solid3d::Response;

use crate::args::{CheckArgs, PAIRS_MAX_DEFAULT, PAIRS_MAX_OF_MANY_POINTS};
use crate::output::{self, is_stdout};
use crate::placements::Placements;
use crate::rays;
use crate::record::{CsvColumns, CsvRecorder, JsonRecorder, Recorder};
use crate::rules::{self, Objects, Rules};
use crate::table::Style;
use crate::warnings::Warnings;
use crate::{Verdict, progress, scene};
use clock::{Clock, Times};
use crowd::Crowd;
use motion::Motion;
use player::Player;
use report::Report;
use stage::Stage;
use timeline::Timeline;

/// Checks what the command line says.
pub fn run(args: &CheckArgs) -> Result<Verdict> {
    files::refuse_clashes(args)?;
    let (mut clock, mut times) = (Clock::start(), Times::default());
    let mut warnings = Warnings::default();
    let mut rules = args.rules.as_deref().map(Rules::read).transpose()?.unwrap_or_default();
    rules.declare_solid(&args.solid);
    rules.declare_decomposed(&args.decompose);
    let rays = rays::all(&args.ray, rules.rays())?;
    let scene = scene::load(&args.scene)?;
    files::refuse_overwriting_parts(args, &scene)?;
    warnings.tell_all(scene::warnings(&scene));
    let placements = placements(args, &scene, &mut warnings)?;
    let timeline = timeline(args, &scene, placements.as_ref())?;
    let motion = match &placements {
        Some(placements) => Motion::table(&scene, placements),
        None => Motion::animation(&scene),
    };
    let is_mesh = |object: usize| scene.objects()[object].shape().triangles().is_some();
    let (bodies, unmatched) = rules::bodies(&rules, &names(&scene), is_mesh)?;
    warnings.tell_all(unmatched);
    let shapes = progress::while_waiting("preparing the shapes", || bodies::shapes(&scene, &bodies))?;
    let tested = if args.continuous { solid3d::Motion::Swept } else { solid3d::Motion::Sampled };
    let mut stage = Stage::new(&scene, &shapes, motion, tested, timeline.time(0))?;
    let clearance = set_rules(&rules, args, &scene, &mut stage, &mut warnings)?;
    let has_clearance = clearance.is_some();
    let crowd = Crowd::new(pairs_max(args, &rules), clearance.unwrap_or(0.0), tested);
    let tells_distances = has_clearance || rules.tell_depth(args.response.map(Response::from));
    let has_rays = !rays.is_empty();
    let columns =
        CsvColumns { distances: tells_distances || has_rays, rays: has_rays, contact_time: args.continuous };
    let recorders = recorders(args, columns, &scene)?;
    clock.lap(&mut times.load);

    let mut player = Player { scene: &scene, stage, crowd, has_clearance, rays, recorders, clock, times };
    let findings = player.play(&timeline);
    // Now, that no progress bar is in the way; also where an error ended the play.
    warnings.tell_all(player.stage.absences());
    let findings = findings?;
    if scene.objects().len() == 1 && !has_rays {
        warnings.tell(alone(args));
    }
    let statistics = player.stage.statistics();
    let report =
        Report { scene: &scene, findings: &findings, rays: &player.rays, statistics, times: player.times };
    print(args, &report)?;
    if args.strict {
        warnings.refuse()?;
    }
    let summary = findings.summary();
    let near = summary.near.is_some_and(|near| near.near_pairs > 0);
    Ok(if near || summary.collisions > 0 { Verdict::Collisions } else { Verdict::Clean })
}

/// Of how many pairs the boxes may overlap.
fn pairs_max(args: &CheckArgs, rules: &Rules) -> u64 {
    let default = match rules.tell_many_points(args.response.map(Response::from)) {
        true => PAIRS_MAX_OF_MANY_POINTS,
        false => PAIRS_MAX_DEFAULT,
    };
    args.max_pairs.unwrap_or(default)
}

/// That there is one object, in words.
fn alone(args: &CheckArgs) -> String {
    let obj = !args.scene.split && args.scene.files.iter().any(|file| Format::of(file) == Some(Format::Obj));
    let hint = if obj { "; --split makes each object and group of an OBJ file one" } else { "" };
    format!("there is one object alone, so that nothing can collide{hint}")
}

fn placements(args: &CheckArgs, scene: &Scene, warnings: &mut Warnings) -> Result<Option<Placements>> {
    let Some(path) = &args.placements else {
        return Ok(None);
    };
    let names = names(scene);
    let placements = Placements::read(path, &names)?;
    warnings.tell_all(placements.repetition(&names));
    if placements.rows().is_empty() {
        warnings.tell(format_args!("{}: there are no rows; nothing is placed", path.display()));
    }
    Ok(Some(placements))
}

fn timeline(args: &CheckArgs, scene: &Scene, placements: Option<&Placements>) -> Result<Timeline> {
    let Some(placements) = placements else {
        return Timeline::between(args.from.unwrap_or(0.0), args.to.unwrap_or(scene.duration()), args.fps);
    };
    let place = || placements.rows().last().map(|row| placements.place(row.line)).unwrap_or_default();
    Timeline::until(placements.last_frame(), args.fps).with_context(place)
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.objects().iter().map(|object| object.name()).collect()
}

/// Brings responses and clearances into the world. Returns the greatest clearance, if there is any.
fn set_rules(
    rules: &Rules,
    args: &CheckArgs,
    scene: &Scene,
    stage: &mut Stage,
    warnings: &mut Warnings,
) -> Result<Option<f64>> {
    let exempt = root_paths::pairs(scene.objects());
    let names = names(scene);
    let (world, ids) = stage.world();
    let objects = Objects { names: &names, ids, exempt: &exempt };
    warnings.tell_all(rules::apply(rules, args.response.map(Response::from), &objects, world)?);
    rules::set_clearances(rules, args.clearance, &objects, world)
}

/// The recorders that write files.
fn recorders(args: &CheckArgs, columns: CsvColumns, scene: &Scene) -> Result<Vec<Box<dyn Recorder>>> {
    let mut recorders: Vec<Box<dyn Recorder>> = Vec::new();
    if let Some(path) = &args.json {
        recorders.push(Box::new(JsonRecorder::new(output::open(path)?, scene)?));
    }
    if let Some(path) = &args.csv {
        recorders.push(Box::new(CsvRecorder::new(output::open(path)?, columns)?));
    }
    Ok(recorders)
}

/// Prints the report. When standard output carries data, it carries nothing else: then there is no table, and statistics,
/// if asked for, go to standard error.
fn print(args: &CheckArgs, report: &Report) -> Result<()> {
    let piped = [&args.json, &args.csv].into_iter().flatten().any(|path| is_stdout(path));
    let mut output = if piped { output::stderr() } else { output::stdout() };
    if !piped {
        let style = Style::on(std::io::stdout().is_terminal());
        output.write_all(report.text(style).as_bytes())?;
    }
    if args.stats {
        output.write_all(report.statistics().as_bytes())?;
    }
    Ok(output.flush()?)
}
