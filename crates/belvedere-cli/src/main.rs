//! The belvedere command line: parse, call the core, write, report.

mod arguments;
mod commands;
mod device;
mod environment;
mod help;
mod in_tiles;
mod inputs;
mod interrupt;
mod memory;
mod outputs;
mod parameter_flags;
mod pipeline;
mod progress;
mod run;
mod scene_config;
mod simulated;
mod summary;
mod typed_command;
mod written_files;

use belvedere::shown::is_command;
use clap::FromArgMatches;
use std::process::ExitCode;

fn main() -> ExitCode {
    interrupt::listen();
    let program = help::command();
    let typed = environment::words();
    let matches = match program.clone().try_get_matches_from(&typed) {
        Ok(matches) => matches,
        Err(error) => refusal(&scene_config::advised(error, &program, &typed), &typed),
    };
    let mut cli = match arguments::Cli::from_arg_matches(&matches) {
        Ok(cli) => cli,
        Err(error) => refusal(&error, &typed),
    };
    cli.global.command = typed_command::described(&program, &matches);
    match written_files::check(&program, &matches).and_then(|()| commands::run(&mut cli)) {
        Ok(summary) => summary.print(&cli.global),
        Err(error) => failure(&parameter_flags::with_flag(error, &program, &matches)),
    }
}

/// Says why what was typed is refused, or gives the help that was wanted. Words that command a terminal are printed
/// without colours, which are commands too.
fn refusal(error: &clap::Error, typed: &[std::ffi::OsString]) -> ! {
    if typed.iter().any(|word| word.to_string_lossy().contains(is_command)) {
        summary::note(error.render().to_string().trim_end());
        std::process::exit(error.exit_code());
    }
    error.exit()
}

fn failure(error: &anyhow::Error) -> ExitCode {
    if matches!(error.downcast_ref(), Some(belvedere::Error::Cancelled)) {
        return interrupt::exit();
    }
    // a reader that closes its pipe, such as `head`, is not an error
    if is_broken_pipe(error) {
        return ExitCode::SUCCESS;
    }
    summary::print_error(error);
    if error.downcast_ref::<arguments::Usage>().is_some() { ExitCode::from(2) } else { ExitCode::FAILURE }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .any(|cause| cause.downcast_ref::<std::io::Error>().is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe))
}
