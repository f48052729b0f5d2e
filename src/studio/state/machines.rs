//! The connection with other computers: its state, and the run that computes on them.
//!
//! While a server is connected, the run in progress gets an evaluator on its workers and on the threads of this computer.
//! It takes effect with the run's next generation, and no bit depends on it.

use std::time::Duration;

use bevy::prelude::*;

use super::current_run::CurrentRun;
use crate::studio::commands::MachinesCommand;
use crate::studio::ui::notifications::Notices;
use snakes_cluster::{BrokerOptions, Machines, ServerWatch, WatchNews, WatchedRun};
use snakes_core::save::LONGEST_ADDRESS;

/// The connection with other computers.
#[derive(Resource, Debug, Default)]
pub(crate) struct MachinesLink {
    /// The address that was used last; empty if there was none.
    address: String,
    state: LinkState,
    watch: Option<ServerWatch>,
    /// The number of the run for which a coordinator was asked, and what was asked.
    asked: Option<(u32, WatchedRun)>,
}

/// State of the connection.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) enum LinkState {
    /// Not connected.
    #[default]
    Off,
    /// The connection is not made yet. Holds why the latest attempt failed, in a line.
    Connecting(Option<String>),
    /// Connected.
    Connected(Box<KnownServer>),
    /// The connection ended by itself, and why, in a line.
    Failed(String),
}

/// Knowledge about a connected server.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct KnownServer {
    /// The proof of the engine of this program.
    pub proof: String,
    /// The machines that were listed last.
    pub machines: Option<Machines>,
    /// Why the latest request failed, in a line.
    pub problem: Option<String>,
    /// The name of this window's run on the server.
    pub own_run: Option<String>,
}

/// How long closing the window waits until the server is told.
const LAST_WAIT: Duration = Duration::from_secs(2);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<MachinesLink>()
        .add_systems(FixedUpdate, take_in)
        .add_systems(Last, leave_at_the_end);
}

impl MachinesLink {
    /// The address that was used last; empty if there was none.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// State of the connection.
    pub fn state(&self) -> &LinkState {
        &self.state
    }

    /// Offers an address of an earlier session, if it is one.
    pub fn remember(&mut self, address: &str) {
        self.address = checked(address).unwrap_or_default();
    }

    /// A link in this state, without a connection.
    #[cfg(test)]
    pub fn of_test(address: &str, state: LinkState) -> Self {
        Self { address: address.to_owned(), state, ..Self::default() }
    }

    /// Executes a command.
    ///
    /// # Errors
    /// The address is none, or the system refuses a thread, with the reason.
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

    /// Stops using the server at once; the rest of the disconnection happens in the background.
    fn disconnect(&mut self, run: &mut CurrentRun) {
        run.share(None);
        (self.watch, self.asked, self.state) = (None, None, LinkState::Off);
    }

    /// Takes over what the watch tells.
    fn take_in(&mut self, run: &mut CurrentRun, notices: &mut Notices) {
        let Some(watch) = &self.watch else { return };
        let news: Vec<WatchNews> = std::iter::from_fn(|| watch.poll()).collect();
        for news in news {
            self.take_in_news(news, run, notices);
        }
    }

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
                // Another run may have taken the place of the one that was asked for.
                if self.asked.as_ref() == Some(&(run.number(), asked)) {
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

    /// Asks for a coordinator of the run in progress, if that has changed.
    fn follow(&mut self, run: &mut CurrentRun) {
        let (Some(watch), LinkState::Connected(known)) = (&self.watch, &mut self.state) else {
            return;
        };
        let wanted = run
            .to_share()
            .map(|name| (run.number(), WatchedRun { name, local_threads: run.threads() }));
        if wanted != self.asked {
            run.share(None);
            known.own_run = None;
            watch.coordinate(wanted.as_ref().map(|(_, run)| run.clone()));
            self.asked = wanted;
        }
    }
}

/// The address as it is used: without spaces, with `nats://` if it names no protocol. The error does not repeat a
/// password.
///
/// # Errors
/// It is none, in a sentence.
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

/// Takes over what the watch tells, and lets the run in progress compute on the workers.
fn take_in(
    mut link: ResMut<MachinesLink>,
    mut run: ResMut<CurrentRun>,
    mut notices: ResMut<Notices>,
) {
    // Workers whose results were wrong get no more work from this window until a person connects again.
    if let Some(reason) = run.take_fault() {
        link.disconnect(&mut run);
        link.state = LinkState::Failed(reason);
    }
    if link.watch.is_some() {
        link.take_in(&mut run, &mut notices);
        link.follow(&mut run);
    }
}

/// When the window closes, takes the run's work from the server.
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
