//! The command `faceformer`: drawings in, faces, solids and pictures out.

mod args;
mod check;
mod eval;
mod failure;
mod features;
mod output;
mod render;
mod solid;
mod source;
mod stages;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};

fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match &cli.command {
        Command::Check(args) => check::run(args),
        Command::Identify(args) => stages::run_identify(args),
        Command::Lift(args) => stages::run_lift(args),
        Command::Solid(args) => solid::run(args),
        Command::Eval(args) => eval::run(args),
        Command::Features(args) => features::run(args),
        Command::Render(args) => render::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("faceformer: {failure}");
            failure.exit_code()
        }
    }
}
