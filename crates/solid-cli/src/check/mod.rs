//! `solid check`: a scene, played and tested frame by frame.

mod clock;
mod motion;
mod report;
mod root_paths;
mod stage;
mod timeline;

use std::io::{IsTerminal, Write};

use anyhow::{Context, Result, bail};
use solid_scene::Scene;
use solid3d::Response;

use crate::args::CheckArgs;
use crate::output::{self, is_stdout};
use crate::placements::Placements;
use crate::progress::Progress;
use crate::record::{CsvRecorder, Frame, Hit, JsonRecorder, PairRecorder, Recorder};
use crate::rules::{self, Objects, Rules};
use crate::table::Style;
use crate::{Verdict, complain, scene};
use clock::{Clock, Times};
use motion::Motion;
use report::Report;
use stage::Stage;
use timeline::Timeline;

/// Checks what the command line says.
pub fn run(args: &CheckArgs) -> Result<Verdict> {
    refuse_shared_output(args)?;
    let (mut clock, mut times) = (Clock::start(), Times::default());
    let rules = args.rules.as_deref().map(Rules::read).transpose()?.unwrap_or_default();
    let scene = scene::load(&args.scene)?;
    scene::warnings(&scene).for_each(|warning| complain("warning", warning));
    let placements = placements(args, &scene)?;
    let timeline = timeline(args, &scene, placements.as_ref())?;
    let motion = match &placements {
        Some(placements) => Motion::table(&scene, placements),
        None => Motion::animation(&scene),
    };
    let mut stage = Stage::new(&scene, motion, timeline.time(0))?;
    set_responses(&rules, args.response.map(Response::from), &scene, &mut stage)?;
    let mut recorders = recorders(args, &scene)?;
    clock.lap(&mut times.load);

    let pairs = play(&scene, &timeline, &mut stage, &mut recorders, (&mut clock, &mut times))?;
    let report = Report { scene: &scene, pairs: &pairs, statistics: stage.statistics(), times };
    print(args, &report)?;
    Ok(if pairs.summary().collisions > 0 { Verdict::Collisions } else { Verdict::Clean })
}

/// Two outputs can't go to one place.
fn refuse_shared_output(args: &CheckArgs) -> Result<()> {
    match (&args.json, &args.csv) {
        (Some(json), Some(csv)) if json == csv => {
            bail!("--json and --csv both write to {}; expected different files", json.display())
        }
        _ => Ok(()),
    }
}

fn placements(args: &CheckArgs, scene: &Scene) -> Result<Option<Placements>> {
    let Some(path) = &args.placements else {
        return Ok(None);
    };
    let placements = Placements::read(path, &names(scene))?;
    if placements.rows().is_empty() {
        complain("warning", format_args!("{}: there are no rows; nothing is placed", path.display()));
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

fn set_responses(rules: &Rules, default: Option<Response>, scene: &Scene, stage: &mut Stage) -> Result<()> {
    let exempt = root_paths::pairs(scene.objects());
    let names = names(scene);
    let (world, ids) = stage.world();
    let objects = Objects { names: &names, ids, exempt: &exempt };
    let warnings = rules::apply(rules, default, &objects, world)?;
    warnings.iter().for_each(|warning| complain("warning", warning));
    Ok(())
}

/// The recorders that write files.
fn recorders(args: &CheckArgs, scene: &Scene) -> Result<Vec<Box<dyn Recorder>>> {
    let mut recorders: Vec<Box<dyn Recorder>> = Vec::new();
    if let Some(path) = &args.json {
        recorders.push(Box::new(JsonRecorder::new(output::open(path)?, scene)?));
    }
    if let Some(path) = &args.csv {
        recorders.push(Box::new(CsvRecorder::new(output::open(path)?)?));
    }
    Ok(recorders)
}

/// Shows and tests every frame.
fn play(
    scene: &Scene,
    timeline: &Timeline,
    stage: &mut Stage,
    recorders: &mut [Box<dyn Recorder>],
    (clock, times): (&mut Clock, &mut Times),
) -> Result<PairRecorder> {
    let mut pairs = PairRecorder::default();
    let mut progress = Progress::new(timeline.frames());
    let mut hits: Vec<Hit> = Vec::new();
    for number in 0..timeline.frames() {
        let time = timeline.time(number);
        stage.show(number, time)?;
        clock.lap(&mut times.moving);
        stage.test(&mut hits);
        clock.lap(&mut times.testing);
        let frame = Frame { number, time, hits: &hits };
        pairs.frame(scene, &frame)?;
        recorders.iter_mut().try_for_each(|recorder| recorder.frame(scene, &frame))?;
        progress.done(number + 1);
        clock.lap(&mut times.writing);
    }
    let summary = pairs.summary();
    recorders.iter_mut().try_for_each(|recorder| recorder.finish(&summary))?;
    clock.lap(&mut times.writing);
    Ok(pairs)
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
