//! The command `solid-lab`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "it is a command")]

use std::path::PathBuf;

use anyhow::Context;
use clap::{Args, Parser, Subcommand};
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
    },
    /// The library beside the thesis's design and parry
    Peers(PeersArgs),
}

#[derive(Debug, Args)]
struct PeersArgs {
    /// Small samples, and nothing that takes seconds to set up
    #[arg(long)]
    quick: bool,
    /// Of the random inputs
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Write the rows as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Draw the ratios, as SVG
    #[arg(long, value_name = "FILE")]
    chart: Option<PathBuf>,
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::List => anyhow::bail!("no experiments yet"),
        Command::Run { name, .. } => anyhow::bail!("there is no experiment {name:?}"),
        Command::Peers(args) => compare(&args),
    }
}

fn compare(args: &PeersArgs) -> anyhow::Result<()> {
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    eprintln!("seed {}", args.seed);
    let report = peers::run(effort, args.seed, |name| eprintln!("{name} ..."));
    println!("{}", peers::table(&report));
    if let Some(path) = &args.json {
        let json = serde_json::to_string_pretty(&report)?;
        std::fs::write(path, json).with_context(|| format!("cannot write {}", path.display()))?;
    }
    if let Some(path) = &args.chart {
        peers::draw(&report, path).with_context(|| format!("cannot draw {}", path.display()))?;
    }
    Ok(())
}
