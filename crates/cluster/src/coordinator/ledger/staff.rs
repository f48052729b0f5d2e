//! The workers of a run: which are present, which are proven, and the results of new workers that are held.

use std::collections::BTreeMap;
use std::time::Instant;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::hello::{WorkerNotice, own_engine};
use crate::names::SILENCE;
use crate::wire::TaskText;

/// Maximum number of workers. Notices of further workers are ignored.
const MOST_MEMBERS: usize = 20_000;
/// Maximum number of workers whose arrival is reported to the user.
const MOST_TOLD: usize = 50;

/// Whether results of a worker count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// No result of the worker has been checked. Its results are held.
    New,
    /// A checked result of the worker had the bits that the coordinator's machine computes. Its results count.
    Proven,
    /// The worker computes with another engine. It gets no batches of this run.
    Foreign,
    /// The worker sent a wrong result. None of its results count.
    SetAside,
}

/// A worker, as the ledger knows it.
#[derive(Debug, Clone)]
pub struct StaffMember {
    /// Latest notice of the worker; `None` if only results have arrived from it.
    pub notice: Option<WorkerNotice>,
    /// Whether the worker's results count.
    pub standing: Standing,
    /// Results that count as soon as the worker is proven.
    pub held: Vec<TaskText>,
    /// Number of the worker's results that counted.
    pub results: u64,
    seen: Instant,
    is_being_proven: bool,
    /// Whether the worker's arrival was reported to the user.
    is_told: bool,
}

/// All workers, by name.
#[derive(Debug, Default)]
pub struct Staff(BTreeMap<String, StaffMember>);

impl StaffMember {
    fn new(now: Instant) -> Self {
        Self {
            notice: None,
            standing: Standing::New,
            held: Vec::new(),
            results: 0,
            seen: now,
            is_being_proven: false,
            is_told: false,
        }
    }

    /// Returns the name of the worker's computer.
    pub fn host(&self) -> &str {
        self.notice.as_ref().map_or("an unknown computer", |notice| &notice.host)
    }

    fn works(&self) -> bool {
        matches!(self.standing, Standing::New | Standing::Proven)
            && self.notice.as_ref().is_some_and(|notice| !notice.leaves)
    }
}

impl Staff {
    /// Returns the number of present workers whose results may count.
    pub fn workers(&self) -> usize {
        self.0.values().filter(|member| member.works()).count()
    }

    /// Returns the number of threads of the present workers whose results may count.
    pub fn threads(&self) -> usize {
        let works = self.0.values().filter(|member| member.works());
        works.filter_map(|member| Some(member.notice.as_ref()?.threads as usize)).sum()
    }

    /// Returns whether a present worker waits for its server.
    pub fn has_waiting(&self) -> bool {
        let waits = |notice: &WorkerNotice| notice.trouble.is_some();
        self.0.values().any(|member| member.works() && member.notice.as_ref().is_some_and(waits))
    }

    /// Returns the names of the workers that were set aside.
    pub fn set_aside_names(&self) -> Vec<String> {
        let is_it = |(_, member): &(&String, &StaffMember)| member.standing == Standing::SetAside;
        self.0.iter().filter(is_it).map(|(name, _)| name.clone()).collect()
    }

    /// Records a worker's notice. Returns lines for the user.
    pub fn on_notice(&mut self, notice: WorkerNotice, proof: &str, now: Instant) -> Vec<String> {
        let name = notice.worker.clone();
        let is_new = !self.0.contains_key(&name);
        if is_new && self.0.len() >= MOST_MEMBERS {
            return Vec::new();
        }
        let is_told = self.0.len() < MOST_TOLD;
        let member = self.0.entry(name.clone()).or_insert_with(|| StaffMember::new(now));
        member.seen = now;
        let mut lines = Vec::new();
        if notice.proof != proof && member.standing != Standing::Foreign {
            member.standing = Standing::Foreign;
            lines.push(format!(
                "worker {name} on {} computes with {}, this run with {}: it gets no work",
                notice.host,
                notice.engine_words(),
                own_engine(proof)
            ));
        } else if is_new && is_told && !notice.leaves {
            let threads = notice.threads;
            let plural = if threads == 1 { "" } else { "s" };
            lines.push(format!("worker {name} on {}: {threads} thread{plural}", notice.host));
            member.is_told = true;
        }
        lines.extend(self.news_of_trouble(&notice));
        let member = self.0.entry(name.clone()).or_insert_with(|| StaffMember::new(now));
        let left = notice.leaves && member.notice.as_ref().is_some_and(|before| !before.leaves);
        if left {
            lines.push(format!("worker {name} on {} left", notice.host));
        }
        member.notice = Some(notice);
        lines
    }

    /// Returns lines for the user about the trouble of a worker with its server, if that has changed since the worker's
    /// notice before. What several workers suffer from is told of the first one, and is over with the last.
    fn news_of_trouble(&self, notice: &WorkerNotice) -> Vec<String> {
        let trouble_of = |name: &str| self.0.get(name)?.notice.as_ref()?.trouble.clone();
        let before = trouble_of(&notice.worker);
        if before == notice.trouble {
            return Vec::new();
        }
        let is_alone = |trouble: &String| {
            let mut others = self.0.keys().filter(|name| **name != notice.worker);
            !others.any(|name| trouble_of(name).as_ref() == Some(trouble))
        };
        let WorkerNotice { worker, host, .. } = notice;
        let line = |words: String| format!("worker {worker} on {host}: {words}");
        let over = before.filter(is_alone).map(|trouble| line(format!("over: {trouble}")));
        let new = notice
            .trouble
            .clone()
            .filter(is_alone)
            .map(|trouble| line(format!("{trouble}; it is trying again")));
        over.into_iter().chain(new).collect()
    }

    /// Forgets workers that have been silent for `SILENCE`, except those that were set aside. Returns for each the
    /// keys of its held results, and a line about its loss if its arrival was reported and it did not leave.
    pub fn forget_silent(&mut self, now: Instant) -> Vec<(Option<String>, Vec<u64>)> {
        let is_silent = |_: &String, member: &mut StaffMember| {
            now.duration_since(member.seen) > SILENCE && member.standing != Standing::SetAside
        };
        let forgotten: BTreeMap<String, StaffMember> = self.0.extract_if(.., is_silent).collect();
        let lines = forgotten.into_iter().map(|(name, member)| {
            let line = (member.is_told && member.works()).then(|| {
                format!(
                    "worker {name} on {} lost: no sign of it for {} s; others compute what it had",
                    member.host(),
                    SILENCE.as_secs()
                )
            });
            (line, member.held.iter().map(|outcome| outcome.key).collect())
        });
        lines.collect()
    }

    /// Restarts the silence of all workers from now, because no worker could be heard.
    pub fn excuse_silence(&mut self, now: Instant) {
        self.0.values_mut().for_each(|member| member.seen = now);
    }

    /// Returns whether results of a worker count. An unknown worker is new.
    pub fn standing(&self, worker: &str) -> Standing {
        self.0.get(worker).map_or(Standing::New, |member| member.standing)
    }

    /// Holds a result until its worker is proven.
    pub fn hold(&mut self, worker: &str, outcome: TaskText, now: Instant) {
        if self.0.len() >= MOST_MEMBERS && !self.0.contains_key(worker) {
            return;
        }
        let new = || StaffMember::new(now);
        let member = self.0.entry(worker.to_owned()).or_insert_with(new);
        if !member.held.iter().any(|held| held.key == outcome.key) {
            member.held.push(outcome);
        }
    }

    /// Returns whether a result of this task is held.
    pub fn holds(&self, key: u64) -> bool {
        self.0.values().flat_map(|member| &member.held).any(|held| held.key == key)
    }

    /// Drops a held result that is not needed.
    pub fn drop_held(&mut self, worker: &str, key: u64) {
        if let Some(member) = self.0.get_mut(worker) {
            member.held.retain(|held| held.key != key);
        }
    }

    /// Chooses a held result at random for each new worker that has some, unless one is being checked already.
    pub fn to_be_proven(&self, rng: &mut ChaCha8Rng) -> Vec<(String, TaskText)> {
        let mut chosen = Vec::new();
        for (name, member) in &self.0 {
            let waits = member.standing == Standing::New && !member.is_being_proven;
            if waits && !member.held.is_empty() {
                let one = &member.held[rng.random_range(0..member.held.len())];
                chosen.push((name.clone(), one.clone()));
            }
        }
        chosen
    }

    /// Records that a result of this worker is being checked.
    pub fn begin_proof(&mut self, worker: &str) {
        if let Some(member) = self.0.get_mut(worker) {
            member.is_being_proven = true;
        }
    }

    /// Marks the worker as proven, unless it was set aside before. Returns its held results.
    pub fn prove(&mut self, worker: &str) -> Vec<TaskText> {
        let Some(member) = self.0.get_mut(worker) else { return Vec::new() };
        if member.standing == Standing::New {
            member.standing = Standing::Proven;
        }
        std::mem::take(&mut member.held)
    }

    /// Counts a result of this worker.
    pub fn count_result(&mut self, worker: &str) {
        if let Some(member) = self.0.get_mut(worker) {
            member.results += 1;
        }
    }

    /// Sets a worker aside. Returns its state before, or `None` if it is unknown or was set aside already.
    pub fn set_aside(&mut self, worker: &str) -> Option<StaffMember> {
        let member = self.0.get_mut(worker)?;
        if member.standing == Standing::SetAside {
            return None;
        }
        let before = member.clone();
        member.standing = Standing::SetAside;
        member.held.clear();
        Some(before)
    }

    /// Chooses at random a proven and present worker other than this one. Returns `None` if there is none.
    pub fn other_proven(&self, worker: &str, rng: &mut ChaCha8Rng) -> Option<String> {
        let is_it = |(name, member): &(&String, &StaffMember)| {
            member.standing == Standing::Proven && member.works() && *name != worker
        };
        let others: Vec<&String> = self.0.iter().filter(is_it).map(|(name, _)| name).collect();
        (!others.is_empty()).then(|| others[rng.random_range(0..others.len())].clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hello::tests::notice;

    #[test]
    fn f3_what_several_workers_wait_for_is_told_once_and_is_over_with_the_last() {
        let (mut staff, now) = (Staff::default(), Instant::now());
        let mut hear = |worker: &str, trouble: Option<&str>| {
            let trouble = trouble.map(str::to_owned);
            staff.on_notice(WorkerNotice { trouble, ..notice(worker, 1, "p") }, "p", now)
        };
        assert_eq!(hear("a", None), ["worker a on computer: 1 thread"]);
        assert_eq!(hear("b", None), ["worker b on computer: 1 thread"]);
        assert_eq!(hear("a", Some("full")), ["worker a on computer: full; it is trying again"]);
        assert!(hear("a", Some("full")).is_empty() && hear("b", Some("full")).is_empty());
        assert!(hear("a", None).is_empty(), "the other one still waits");
        assert_eq!(hear("b", None), ["worker b on computer: over: full"]);
    }
}
