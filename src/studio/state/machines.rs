//! The connection with other computers: its state, and the run that uses them.
//!
//! While a server is connected, the run in progress gets an evaluator that uses the server's workers and the threads of
//! this computer. It takes effect with the run's next generation, and does not affect any result.

use std::time::Duration;

use bevy::prelude::*;

use super::current_run::CurrentRun;
use crate::studio::commands::MachinesCommand;
use crate::studio::ui::notifications::Notices;
use snakes_cluster::{BrokerOptions, Machines, ServerWatch, WatchNews, WatchedRun};
use snakes_core::save::{LONGEST_ADDRESS, run_name};

/// The connection with other computers, and its state.
#[derive(Resource, Debug, Default)]
pub(crate) struct MachinesLink {
    /// Address that was used last; empty if there was none.
    pub address: String,
    /// State of the connection.
    pub state: LinkState,
    watch: Option<ServerWatch>,
    /// Number of the run for which a coordinator was requested, and the request.
    asked: Option<(u32, WatchedRun)>,
}

/// State of the connection.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) enum LinkState {
    /// There is no connection.
    #[default]
    Off,
    /// The connection is not made yet. Holds the reason in one line why the latest attempt failed, if one did.
    Connecting(Option<String>),
    /// The server is connected, with what is known about it.
    Connected(Box<KnownServer>),
    /// The connection failed or ended, for this reason, in one line.
    Failed(String),
}

/// Information about a connected server.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct KnownServer {
    /// Proof of this program's engine, which workers must match.
    pub proof: String,
    /// Machines in the latest listing, if any.
    pub machines: Option<Machines>,
    /// Reason why the latest request failed, in one line.
    pub problem: Option<String>,
    /// Name of this window's run on the server, while the run uses it.
    pub own_run: Option<String>,
}

/// Maximum time by which closing the window is delayed until the server is informed.
const LAST_WAIT: Duration = Duration::from_secs(2);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<MachinesLink>()
        .add_systems(FixedUpdate, take_in)
        .add_systems(Last, leave_at_the_end);
}

impl MachinesLink {
    /// Sets the address that was stored in the preferences, if it is valid.
    pub fn remember(&mut self, address: &str) {
        self.address = checked(address).unwrap_or_default();
    }

    /// Creates a link in this state without a connection, for tests.
    #[cfg(test)]
    pub fn of_test(address: &str, state: LinkState) -> Self {
        Self { address: address.to_owned(), state, ..Self::default() }
    }

    /// Executes a command to the connection.
    ///
    /// # Errors
    /// The address is invalid, or the operating system refuses to start a thread; the error states the reason.
    pub fn apply(&mut self, command: &MachinesCommand, run: &mut CurrentRun) -> Result<(), String> {
        match command {
            MachinesCommand::Connect(address) => {
                let url = checked(address)?;
                self.disconnect(run);
                let server = BrokerOptions { url: url.clone(), ..BrokerOptions::default() };
                let watch = ServerWatch::start(server);
                self.watch = Some(watch.map_err(|error| format!("Not connected: {error}"))?);
                (self.address, self.state) = (url, LinkState::Connecting(None));
            }
            MachinesCommand::Disconnect => self.disconnect(run),
        }
        Ok(())
    }

    /// Stops using the server at once. The rest of the disconnection happens in the background.
    fn disconnect(&mut self, run: &mut CurrentRun) {
        run.share(None);
        (self.watch, self.asked, self.state) = (None, None, LinkState::Off);
    }

    /// Processes a piece of news from the watch of the server.
    fn take_in_news(&mut self, news: WatchNews, run: &mut CurrentRun, notices: &mut Notices) {
        match (news, &mut self.state) {
            (WatchNews::Connected { proof }, state) => {
                *state =
                    LinkState::Connected(Box::new(KnownServer { proof, ..KnownServer::default() }));
            }
            (WatchNews::Listed(machines), LinkState::Connected(known)) => {
                (known.machines, known.problem) = (Some(machines), None);
            }
            (WatchNews::Trouble(problem), LinkState::Connected(known)) => {
                known.problem = Some(problem);
            }
            (WatchNews::Trouble(problem), LinkState::Connecting(latest)) => *latest = Some(problem),
            (
                WatchNews::Coordinates { run: asked, name, evaluator },
                LinkState::Connected(known),
            ) => {
                // Another run may have replaced the one for which the coordinator was requested.
                if self.asked.as_ref() == Some(&(run.number, asked)) {
                    known.own_run = Some(name);
                    run.share(Some(evaluator));
                }
            }
            (WatchNews::Failed(problem), _) => {
                self.disconnect(run);
                notices.problem(format!("Other computers are not connected: {problem}"));
                self.state = LinkState::Failed(problem);
            }
            (WatchNews::Listed(_) | WatchNews::Trouble(_) | WatchNews::Coordinates { .. }, _) => {}
        }
    }

    /// Requests a coordinator for the run in progress, if the run or its number of threads has changed.
    fn follow(&mut self, run: &mut CurrentRun) {
        let (Some(watch), LinkState::Connected(known)) = (&self.watch, &mut self.state) else {
            return;
        };
        let wanted = run.is_under_way().then(|| {
            let name = run_name(&run.source.plan);
            (run.number, WatchedRun { name, local_threads: run.threads() })
        });
        if wanted != self.asked {
            run.share(None);
            known.own_run = None;
            watch.coordinate(wanted.as_ref().map(|(_, run)| run.clone()));
            self.asked = wanted;
        }
    }
}

/// Returns the address in its normal form: without spaces, and with `nats://` if it names no protocol. The error does
/// not repeat a password.
///
/// # Errors
/// The text is no valid address; the error is a sentence for the user.
pub(crate) fn checked(address: &str) -> Result<String, String> {
    let parts = address.split(',').map(|part| match part.trim() {
        part if part.contains("://") || part.is_empty() => part.to_owned(),
        part => format!("nats://{part}"),
    });
    let url = parts.collect::<Vec<String>>().join(",");
    let refused = |shown: &str| {
        format!(
            "{shown} is not the address of a server. Type nats://HOST:PORT or tls://HOST:PORT, without user name and \
             password."
        )
    };
    if url.len() > LONGEST_ADDRESS || url.contains(|c: char| c.is_whitespace() || c.is_control()) {
        return Err(refused("This text"));
    }
    let options = BrokerOptions { url, ..BrokerOptions::default() };
    options.check().map_err(|error| refused(&error.value))?;
    Ok(options.url)
}

/// Processes the news from the server, and lets the run in progress use its workers.
fn take_in(
    mut link: ResMut<MachinesLink>,
    mut run: ResMut<CurrentRun>,
    mut notices: ResMut<Notices>,
) {
    // Workers whose results were wrong get no more work from this window until the user connects again.
    if let Some(reason) = run.fault.take() {
        link.disconnect(&mut run);
        link.state = LinkState::Failed(reason);
    }
    if let Some(watch) = &link.watch {
        let news: Vec<WatchNews> = std::iter::from_fn(|| watch.poll()).collect();
        news.into_iter().for_each(|news| link.take_in_news(news, &mut run, &mut notices));
        link.follow(&mut run);
    }
}

/// When the window closes, removes the run's work from the server.
fn leave_at_the_end(
    mut exits: MessageReader<AppExit>,
    mut link: ResMut<MachinesLink>,
    mut run: ResMut<CurrentRun>,
) {
    if exits.read().next().is_some()
        && let Some(watch) = link.watch.take()
    {
        link.disconnect(&mut run);
        run.stop_at_the_end();
        watch.end_within(LAST_WAIT);
    }
}

#[cfg(test)]
mod tests;
