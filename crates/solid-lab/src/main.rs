//! The command `solid-lab`.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{Args, Parser, Subcommand};
use solid_lab::experiments::{self, Experiment, Report, Settings};
use solid_lab::inputs::SEED;
use solid_lab::peers::{self, Effort};

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
    /// Runs an experiment, or all
    Run {
        /// The name of an experiment, or `all`
        name: String,
        /// Small samples: a minute for everything
        #[arg(long)]
        quick: bool,
        /// Of all random numbers
        #[arg(long, default_value_t = SEED)]
        seed: u64,
        /// Where tables and charts go; the folder is made
        #[arg(long, value_name = "FOLDER", default_value = "target/experiments")]
        out: PathBuf,
        /// Put the results between the marks of this document
        #[arg(long, value_name = "FILE")]
        document: Option<PathBuf>,
    },
    /// The library beside the thesis's design and parry
    Peers(PeersArgs),
}

#[derive(Debug, Args)]
struct PeersArgs {
    /// Small samples, and nothing that takes seconds to set up
    #[arg(long)]
    quick: bool,
    /// Of all random numbers
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Write the rows as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Draw the ratios, as SVG
    #[arg(long, value_name = "FILE")]
    chart: Option<PathBuf>,
}

fn main() -> Result<()> {
    match Cli::parse().command {
        Command::List => {
            for experiment in experiments::all() {
                println!("{:18} {}", experiment.name, experiment.reproduces);
            }
            Ok(())
        }
        Command::Run { name, quick, seed, out, document } => {
            let effort = if quick { experiments::Effort::Quick } else { experiments::Effort::Full };
            run(&name, &Settings { effort, seed, out_dir: out }, document.as_deref())
        }
        Command::Peers(args) => compare(&args),
    }
}

fn run(name: &str, settings: &Settings, document: Option<&Path>) -> Result<()> {
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
    let mut found = Vec::new();
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
        found.push((experiment, report));
    }
    println!("\ntables and charts are in {}; {:.1} s", out.display(), start.elapsed().as_secs_f64());
    if let Some(document) = document {
        experiments::write_summary(document, &found)?;
    }
    let differing: usize = found.iter().map(|(_, report)| differences(report)).sum();
    println!("{differing} counts differ from the thesis's");
    Ok(())
}

fn differences(report: &Report) -> usize {
    report.claims.iter().filter(|claim| claim.agrees() == Some(false)).count()
}

fn compare(args: &PeersArgs) -> Result<()> {
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    eprintln!("seed {}", args.seed);
    let start = Instant::now();
    let report = peers::run(effort, args.seed, |name| {
        eprintln!("{:5.1} s: {name}", start.elapsed().as_secs_f64());
    });
    println!("{}", peers::table(&report));
    if let Some(path) = &args.json {
        let json = serde_json::to_string_pretty(&report)?;
        fs::write(path, json).with_context(|| format!("cannot write {}", path.display()))?;
    }
    if let Some(path) = &args.chart {
        peers::draw(&report, path).with_context(|| format!("cannot draw {}", path.display()))?;
    }
    Ok(())
}
