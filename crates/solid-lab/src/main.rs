//! The command `solid-lab`.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

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
    Peers {
        /// Small samples: seconds
        #[arg(long)]
        quick: bool,
        /// Write the rows as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
    },
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::List => anyhow::bail!("no experiments yet"),
        Command::Run { name, .. } => anyhow::bail!("there is no experiment {name:?}"),
        Command::Peers { .. } => anyhow::bail!("no peers yet"),
    }
}
