//! The connections of a server: few at once, and those that rest make room for others.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::Notify;
use tokio::task::AbortHandle;

/// Minimum idle time of a connection before it makes room for another: a new one has its request read by then.
const MIN_REST: Duration = Duration::from_millis(40);
/// Interval of the search for one.
const POLL: Duration = Duration::from_millis(5);

/// The open connections of a server.
#[derive(Default)]
pub(crate) struct Connections {
    open: Mutex<OpenConnections>,
    /// Notified when a connection ends or becomes idle.
    changed: Notify,
}

#[derive(Default)]
struct OpenConnections {
    by_number: HashMap<u64, OpenConnection>,
    /// Connections so far.
    count: u64,
}

struct OpenConnection {
    /// Handle that ends it; `None` until its task runs.
    task: Option<AbortHandle>,
    /// Requests that are being answered.
    requests: usize,
    /// Time at which it became idle.
    rests_since: Instant,
}

/// A connection that is open until this is dropped.
pub(crate) struct Place {
    connections: Arc<Connections>,
    number: u64,
}

/// A request that is being answered until this is dropped.
pub(crate) struct AnsweredRequest(Arc<Place>);

impl Connections {
    /// A place for one more connection beside at most `max` others. Where there is none, the connection that rests for
    /// longest is ended; where none rests, one is waited for.
    pub(crate) async fn place(self: &Arc<Self>, max: usize) -> Place {
        loop {
            if let Some(number) = self.number(max) {
                return Place { connections: Arc::clone(self), number };
            }
            // one that rests may have rested long enough by then
            let _ = tokio::time::timeout(POLL, self.changed.notified()).await;
        }
    }

    fn number(&self, max: usize) -> Option<u64> {
        let mut open = self.open();
        if open.by_number.len() >= max {
            open.end_one(MIN_REST);
        }
        if open.by_number.len() >= max {
            return None;
        }
        open.count += 1;
        let number = open.count;
        open.by_number.insert(number, OpenConnection { task: None, requests: 0, rests_since: Instant::now() });
        Some(number)
    }

    /// Ends the connection that rests for longest, if one does.
    pub(crate) fn end_one(&self) {
        self.open().end_one(Duration::ZERO);
    }

    fn open(&self) -> MutexGuard<'_, OpenConnections> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl OpenConnections {
    /// Ends the connection that rests for longest, if one rests for so long.
    fn end_one(&mut self, rest: Duration) {
        let is_resting =
            |connection: &OpenConnection| connection.requests == 0 && connection.rests_since.elapsed() >= rest;
        let resting = self.by_number.iter().filter(|(_, connection)| is_resting(connection));
        let longest = resting.min_by_key(|(_, connection)| connection.rests_since).map(|(&number, _)| number);
        if let Some(task) = longest.and_then(|number| self.by_number.remove(&number)?.task) {
            task.abort();
        }
    }
}

impl Place {
    /// Names the task that answers the connection, so that it can be ended.
    pub(crate) fn set_task(&self, task: AbortHandle) {
        if let Some(own) = self.connections.open().by_number.get_mut(&self.number) {
            own.task = Some(task);
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.connections.open().by_number.remove(&self.number);
        self.connections.changed.notify_one();
    }
}

impl AnsweredRequest {
    pub(crate) fn of(place: &Arc<Place>) -> Self {
        if let Some(own) = place.connections.open().by_number.get_mut(&place.number) {
            own.requests += 1;
        }
        Self(Arc::clone(place))
    }
}

impl Drop for AnsweredRequest {
    fn drop(&mut self) {
        let mut open = self.0.connections.open();
        if let Some(own) = open.by_number.get_mut(&self.0.number) {
            own.requests = own.requests.saturating_sub(1);
            own.rests_since = Instant::now();
        }
        drop(open);
        self.0.connections.changed.notify_one();
    }
}
