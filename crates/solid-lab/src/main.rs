//! The command `solid-lab`.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use solid_lab::document;
use solid_lab::experiments::{self, Experiment, Report, Settings};
use solid_lab::inputs::SEED;
use solid_lab::peers::{self, Effort};
use solid_lab::{questions, threads};

/// Measures again what the thesis measured, and the library beside its peers
#[derive(Debug, Parser)]
#[command(name = "solid-lab", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Names the experiments
    List,
    /// Runs an experiment, or all of them, the comparisons with the peers, and that of one thread and two
    Run {
        /// The name of an experiment, or `all`
        name: String,
        #[command(flatten)]
        measuring: Measuring,
        /// Where tables and charts go; the folder is made
        #[arg(long, value_name = "FOLDER", default_value = "target/experiments", conflicts_with = "docs")]
        out: PathBuf,
        /// Bring `experiments.md`, `peers.md` and their charts in this folder up to date
        #[arg(long, value_name = "FOLDER")]
        docs: Option<PathBuf>,
    },
    /// The library beside the thesis's design and parry
    Peers {
        #[command(flatten)]
        measuring: Measuring,
        /// Groups of cases; all if none is named
        #[arg(value_name = "GROUP", value_parser = PossibleValuesParser::new(peers::groups()))]
        only: Vec<String>,
        /// Write the rows as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Draw the ratios, as SVG
        #[arg(long, value_name = "FILE")]
        chart: Option<PathBuf>,
    },
    /// Every question of every pair of kinds beside parry
    Questions {
        #[command(flatten)]
        measuring: Measuring,
        /// Bring `peers.md` in this folder up to date
        #[arg(long, value_name = "FOLDER")]
        docs: Option<PathBuf>,
    },
    /// One thread against two
    Threads {
        #[command(flatten)]
        measuring: Measuring,
        /// Bring `experiments.md` in this folder up to date
        #[arg(long, value_name = "FOLDER")]
        docs: Option<PathBuf>,
    },
}

#[derive(Clone, Copy, Debug, Args)]
struct Measuring {
    /// Small samples, and nothing that takes seconds to set up: a minute for everything
    #[arg(long)]
    quick: bool,
    /// Of all random numbers
    #[arg(long, default_value_t = SEED)]
    seed: u64,
}

fn main() -> Result<()> {
    let command = Cli::parse().command;
    if let Command::Run { docs: Some(docs), .. }
    | Command::Questions { docs: Some(docs), .. }
    | Command::Threads { docs: Some(docs), .. } = &command
    {
        document::expect_in(docs)?;
    }
    match command {
        Command::List => {
            for experiment in experiments::all() {
                println!("{:18} {}", experiment.name, experiment.reproduces);
            }
            Ok(())
        }
        Command::Run { name, measuring, out, docs } => {
            let out = docs.as_ref().map_or(out, |docs| docs.join("experiments"));
            let effort = if measuring.quick { experiments::Effort::Quick } else { experiments::Effort::Full };
            threads::on_one(|| {
                run(&name, &Settings { effort, seed: measuring.seed, out_dir: out }, docs.as_deref())?;
                if name == "all" {
                    let chart = docs.as_ref().map(|docs| docs.join("peers.svg"));
                    compare(measuring, &[], None, chart.as_deref(), docs.as_deref())?;
                    ask(measuring, docs.as_deref())?;
                }
                anyhow::Ok(())
            })??;
            if name == "all" { one_and_two(measuring, docs.as_deref()) } else { Ok(()) }
        }
        Command::Peers { measuring, only, json, chart } => {
            threads::on_one(|| compare(measuring, &only, json.as_deref(), chart.as_deref(), None))?
        }
        Command::Questions { measuring, docs } => threads::on_one(|| ask(measuring, docs.as_deref()))?,
        Command::Threads { measuring, docs } => one_and_two(measuring, docs.as_deref()),
    }
}

fn run(name: &str, settings: &Settings, docs: Option<&Path>) -> Result<()> {
    let chosen: Vec<&Experiment> =
        experiments::all().iter().filter(|experiment| name == "all" || experiment.name == name).collect();
    if chosen.is_empty() {
        bail!("there is no experiment {name:?}; `solid-lab list` names them");
    }
    let out = &settings.out_dir;
    fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    println!(
        "seed {}{}",
        settings.seed,
        if settings.effort == experiments::Effort::Full { "" } else { ", small samples" }
    );
    let start = Instant::now();
    let mut results = Vec::new();
    let mut differing = 0;
    for experiment in chosen {
        let begun = Instant::now();
        let report = (experiment.run)(settings)?;
        println!(
            "\n{}: {} ({:.1} s)\n",
            experiment.name,
            experiment.reproduces,
            begun.elapsed().as_secs_f64()
        );
        println!("{}", report.text());
        differing += differences(&report);
        results.push((experiment.name, report.markdown()));
    }
    println!("\ntables and charts are in {}; {:.1} s", out.display(), start.elapsed().as_secs_f64());
    println!("{differing} counts differ from the thesis's");
    match docs {
        Some(docs) => document::fill(&docs.join("experiments.md"), &results),
        None => Ok(()),
    }
}

fn differences(report: &Report) -> usize {
    report.claims.iter().filter(|claim| claim.agrees() == Some(false)).count()
}

fn compare(
    measuring: Measuring,
    only: &[String],
    json: Option<&Path>,
    chart: Option<&Path>,
    docs: Option<&Path>,
) -> Result<()> {
    eprintln!("seed {}", measuring.seed);
    let start = Instant::now();
    let report = peers::run(effort(measuring), measuring.seed, only, |name| {
        eprintln!("{:5.1} s: {name}", start.elapsed().as_secs_f64());
    });
    println!("{}", peers::table(&report));
    eprintln!("{:5.1} s", start.elapsed().as_secs_f64());
    if let Some(path) = json {
        let json = serde_json::to_string_pretty(&report)?;
        fs::write(path, json).with_context(|| format!("cannot write {}", path.display()))?;
    }
    if let Some(path) = chart {
        peers::draw(&report, path).with_context(|| format!("cannot draw {}", path.display()))?;
    }
    if let Some(docs) = docs {
        document::fill(&docs.join("peers.md"), &[("peers", peers::table(&report))])?;
        document::fill(&docs.join("experiments.md"), &[("shortfalls", peers::shortfalls(&report))])?;
    }
    Ok(())
}

fn ask(measuring: Measuring, docs: Option<&Path>) -> Result<()> {
    let start = Instant::now();
    let report = questions::run(effort(measuring), measuring.seed, |name| {
        eprintln!("{:5.1} s: {name}", start.elapsed().as_secs_f64());
    });
    let (table, grounds) = (questions::table(&report), questions::table_of_grounds(&report));
    println!("{table}\n\n{grounds}");
    match docs {
        Some(docs) => document::fill(&docs.join("peers.md"), &[("questions", table), ("grounds", grounds)]),
        None => Ok(()),
    }
}

fn one_and_two(measuring: Measuring, docs: Option<&Path>) -> Result<()> {
    threads::two_by_default()?;
    let start = Instant::now();
    let report = threads::run(effort(measuring), measuring.seed, |name| {
        eprintln!("{:5.1} s: {name}", start.elapsed().as_secs_f64());
    })?;
    let table = threads::table(&report);
    println!("{table}");
    match docs {
        Some(docs) => document::fill(&docs.join("experiments.md"), &[("threads", table)]),
        None => Ok(()),
    }
}

fn effort(measuring: Measuring) -> Effort {
    if measuring.quick { Effort::Quick } else { Effort::Full }
}
