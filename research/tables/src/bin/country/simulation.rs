//! The runs of a whole country on a cluster, in simulated time: which tile is computed when, and what is lost when
//! computers are.
//!
//! A country is cut into plans, each of which has the tiles of a square and of a margin around it. A plan has two
//! stages, as `belvedere city run` has with `--balls-only` and without: answers begin when all balls of the plan are
//! made. Its balls are deleted when its answers are merged. Workers take the next tile of the first plan that has one.
//! A worker that is lost loses the tile that it was computing, which another one computes again; what was recorded
//! before stays. A tile that cannot be computed is tried a few times, then named and left out.

use belvedere::random::uniform;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// What is to be computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Country {
    pub(crate) plans: usize,
    pub(crate) tiles_per_plan: usize,
    /// Seconds of a processor for the balls and for the answers of a tile, on average.
    pub(crate) seconds: [f64; 2],
    /// Balls of a tile on disk, bytes, on average.
    pub(crate) ball_bytes: f64,
    /// Share of the tiles that cannot be computed.
    pub(crate) bad_share: f64,
}

/// Who computes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cluster {
    /// Processors.
    pub(crate) workers: usize,
    /// How long a processor works until it is lost, on average; infinite for never.
    pub(crate) hours_to_loss: f64,
    /// How long it takes until another one takes its place, seconds.
    pub(crate) seconds_to_replace: f64,
    /// How often a tile is tried.
    pub(crate) tries: u32,
    /// Most plans that are begun and not yet merged.
    pub(crate) max_open: usize,
}

/// How it went.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SimulationOutcome {
    /// Seconds from the first tile to the last.
    pub(crate) elapsed: f64,
    /// Seconds of work that was recorded.
    pub(crate) recorded: f64,
    /// Seconds of work on tiles that were lost with their worker, or failed.
    pub(crate) wasted: f64,
    /// How often each stage of each tile was recorded.
    pub(crate) records: Vec<[u8; 2]>,
    /// Tiles that were tried as often as they may be.
    pub(crate) named: usize,
    /// Workers that were lost.
    pub(crate) losses: usize,
    /// Most balls on disk at a time, bytes.
    pub(crate) max_ball_bytes: f64,
}

/// A tile in a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct SimulatedTask {
    plan: usize,
    stage: usize,
    tile: usize,
    tries: u32,
}

/// What happens next; times are milliseconds, so that they have an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    Done(usize, SimulatedTask),
    /// With when it began.
    Lost(usize, SimulatedTask, u64),
    Replaced(usize),
}

#[derive(Clone, Debug, Default)]
struct OpenPlan {
    plan: usize,
    stage: usize,
    /// First tile that nobody has taken yet.
    next: usize,
    again: VecDeque<SimulatedTask>,
    /// Tiles of the stage that are neither recorded nor named.
    left: usize,
    ball_bytes: f64,
}

struct SimulatedRun<'a> {
    country: &'a Country,
    cluster: &'a Cluster,
    now: u64,
    events: BinaryHeap<Reverse<(u64, Event)>>,
    open: VecDeque<OpenPlan>,
    /// The next plan that is not yet begun.
    next_plan: usize,
    idle: Vec<usize>,
    /// When each worker will be lost.
    lost_at: Vec<u64>,
    outcome: SimulationOutcome,
}

/// Computes a country; the same one with the same cluster always goes the same way.
#[must_use]
pub(crate) fn simulate(country: &Country, cluster: &Cluster) -> SimulationOutcome {
    let mut run = SimulatedRun {
        country,
        cluster,
        now: 0,
        events: BinaryHeap::new(),
        open: VecDeque::new(),
        next_plan: 0,
        idle: (0..cluster.workers).rev().collect(),
        lost_at: Vec::new(),
        outcome: SimulationOutcome {
            records: vec![[0; 2]; country.plans * country.tiles_per_plan],
            ..SimulationOutcome::default()
        },
    };
    run.lost_at = (0..cluster.workers).map(|worker| run.until_loss(worker)).collect();
    run.hand_out();
    while let Some(Reverse((now, event))) = run.events.pop() {
        run.now = now;
        run.happens(event);
        run.hand_out();
    }
    run.outcome
}

impl SimulatedRun<'_> {
    /// When a worker that begins now is lost.
    fn until_loss(&self, worker: usize) -> u64 {
        if self.cluster.hours_to_loss.is_infinite() {
            return u64::MAX;
        }
        let u = uniform(self.outcome.losses as u64 + 1, worker as u64);
        self.now.saturating_add(milliseconds(-(1.0 - u).ln() * 3600.0 * self.cluster.hours_to_loss))
    }

    /// How long a tile takes: half to one and a half times the average, and one in a hundred, a city centre, five times
    /// as long.
    fn seconds(&self, task: SimulatedTask) -> f64 {
        let number = (task.plan * self.country.tiles_per_plan + task.tile) as u64;
        let share = if uniform(2, number) < 0.01 { 5.0 } else { 0.5 + uniform(3, number) };
        self.country.seconds[task.stage] * share / 1.04
    }

    fn is_bad(&self, task: SimulatedTask) -> bool {
        let number = (task.plan * self.country.tiles_per_plan + task.tile) as u64;
        task.stage == 0 && uniform(4, number) < self.country.bad_share
    }

    fn hand_out(&mut self) {
        while let Some(&worker) = self.idle.last() {
            let Some(task) = self.next_task() else { return };
            self.idle.pop();
            let end = self.now + milliseconds(self.seconds(task)).max(1);
            let (at, event) = match self.lost_at[worker] < end {
                true => (self.lost_at[worker].max(self.now), Event::Lost(worker, task, self.now)),
                false => (end, Event::Done(worker, task)),
            };
            self.events.push(Reverse((at, event)));
        }
    }

    fn next_task(&mut self) -> Option<SimulatedTask> {
        let tiles = self.country.tiles_per_plan;
        for open in &mut self.open {
            if let Some(task) = open.again.pop_front() {
                return Some(task);
            }
            if open.next < tiles {
                open.next += 1;
                return Some(SimulatedTask { plan: open.plan, stage: open.stage, tile: open.next - 1, tries: 0 });
            }
        }
        if self.next_plan == self.country.plans || self.open.len() == self.cluster.max_open {
            return None;
        }
        self.open.push_back(OpenPlan { plan: self.next_plan, left: tiles, next: 1, ..OpenPlan::default() });
        self.next_plan += 1;
        Some(SimulatedTask { plan: self.next_plan - 1, stage: 0, tile: 0, tries: 0 })
    }

    fn happens(&mut self, event: Event) {
        match event {
            Event::Replaced(worker) => {
                self.lost_at[worker] = self.until_loss(worker);
                self.idle.push(worker);
            }
            Event::Lost(worker, task, begun) => {
                self.outcome.losses += 1;
                let back = self.now + milliseconds(self.cluster.seconds_to_replace);
                self.events.push(Reverse((back, Event::Replaced(worker))));
                self.outcome.wasted += (self.now - begun) as f64 / 1e3;
                self.try_again(task);
            }
            Event::Done(worker, task) => {
                self.idle.push(worker);
                self.outcome.elapsed = self.now as f64 / 1e3;
                let seconds = self.seconds(task);
                if self.is_bad(task) {
                    self.outcome.wasted += seconds;
                    self.try_again(SimulatedTask { tries: task.tries + 1, ..task });
                } else {
                    self.outcome.recorded += seconds;
                    self.outcome.records[task.plan * self.country.tiles_per_plan + task.tile][task.stage] += 1;
                    self.ends(task, true);
                }
            }
        }
    }

    fn try_again(&mut self, task: SimulatedTask) {
        if task.tries == self.cluster.tries {
            self.outcome.named += 1;
            self.ends(task, false);
        } else if let Some(open) = self.open.iter_mut().find(|open| open.plan == task.plan) {
            open.again.push_back(task);
        }
    }

    /// A tile that is recorded or named needs no more work in its stage.
    fn ends(&mut self, task: SimulatedTask, is_recorded: bool) {
        let Some(place) = self.open.iter().position(|open| open.plan == task.plan) else { return };
        let open = &mut self.open[place];
        if is_recorded && task.stage == 0 {
            open.ball_bytes += self.country.ball_bytes;
        }
        open.left -= 1;
        if open.left == 0 && open.stage == 0 {
            *open = OpenPlan { stage: 1, next: 0, left: self.country.tiles_per_plan, ..std::mem::take(open) };
        } else if open.left == 0 {
            self.open.remove(place);
        }
        let on_disk: f64 = self.open.iter().map(|open| open.ball_bytes).sum();
        self.outcome.max_ball_bytes = self.outcome.max_ball_bytes.max(on_disk);
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates: never is far away")]
fn milliseconds(seconds: f64) -> u64 {
    (seconds * 1e3) as u64
}
