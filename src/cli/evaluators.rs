//! The evaluator of a command: threads of this computer, or workers on other computers.

use std::path::Path;
use std::sync::Arc;

use super::args::Args;
use super::error::CliError;
use snakes_lab::run::Evaluator;

/// Starts the evaluator that the flags name. On a server the command has a name made of `words` and `place`, the folder of its
/// results. The same command in the same place therefore finds the results that an interrupted one left there.
pub fn evaluator(args: &Args, words: &str, place: &Path) -> Result<Arc<dyn Evaluator>, CliError> {
    if args.workers.nats.is_none() {
        return args.local_evaluator();
    }
    #[cfg(feature = "cluster")]
    {
        let place = std::path::absolute(place).unwrap_or_else(|_| place.to_owned());
        super::cluster::coordinator(args, words, &place)
    }
    #[cfg(not(feature = "cluster"))]
    {
        let _ = (words, place);
        Err(CliError::NoCluster)
    }
}

/// Returns the result of work with an evaluator, or an error if results that the evaluator reported cannot be trusted. If the work
/// was cancelled because the evaluator can evaluate nothing more, the error says so.
pub fn trusted<T, E: Into<CliError>>(
    evaluator: &dyn Evaluator,
    result: Result<T, E>,
) -> Result<T, CliError> {
    match evaluator.fault() {
        Some(reason) => Err(CliError::Tainted(reason)),
        None => result.map_err(|error| match (error.into(), evaluator.refusal()) {
            (error, Some(reason)) => CliError::Refused(format!("{reason}; {error}")),
            (error, None) => error,
        }),
    }
}
