//! Routes below the token: the page, its points, and questions.

use crate::guard::Guard;
use crate::page;
use crate::replies::Refusal;
use crate::session::Session;
use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::{DefaultBodyLimit, Path, Request, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use belvedere::control::{Control, Watcher};
use serde_json::json;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::sync::Semaphore;

/// Maximum number of bytes of a question: a polygon with a thousand corners.
const MAX_BYTES: usize = 65_536;
/// Maximum number of bytes of a mesh that is loaded.
const MAX_MESH_BYTES: usize = 32 << 20;
/// Maximum time for the rest of a request.
const PATIENCE: Duration = Duration::from_secs(10);
/// Questions that wait or are answered; more are refused.
const MAX_QUESTIONS: usize = 24;
/// The page may load its own files only; nobody may show it in a frame.
const POLICY: &str = "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// State shared by all requests.
struct ServerState {
    session: Session,
    /// One question at a time has all threads.
    turn: Arc<Semaphore>,
    places: Arc<Semaphore>,
}

pub(crate) fn app(guard: Arc<Guard>, session: Session) -> Router {
    let shared =
        ServerState { session, turn: Arc::new(Semaphore::new(1)), places: Arc::new(Semaphore::new(MAX_QUESTIONS)) };
    Router::new()
        .route("/{token}/", get(|| async { file("index.html") }))
        .route("/{token}/{file}", get(|Path((_, path)): Path<(String, String)>| async move { file(&path) }))
        .route("/{token}/state", get(state))
        .route("/{token}/balls", get(part))
        .route("/{token}/points/{chunk}", get(part))
        .route("/{token}/colors/{chunk}", get(part))
        .route("/{token}/meshes/{mesh}", get(part))
        .route("/{token}/results/{file}", get(results))
        .route("/{token}/ask/{question}", post(ask))
        .route("/{token}/plans/{plan}/ask/{question}", post(ask))
        .route("/{token}/plan-meshes/{name}", post(plan_mesh))
        .route("/{token}/reading", post(ask))
        .fallback(|| async { refused(StatusCode::NOT_FOUND, "there is nothing at this address") })
        .layer(DefaultBodyLimit::max(MAX_BYTES))
        .layer(from_fn_with_state(guard, check))
        .layer(from_fn(with_headers))
        .with_state(Arc::new(shared))
}

async fn check(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response {
    match guard.refusal(request.headers(), request.uri().path()) {
        Some((status, message)) => refused(status, message),
        None => next.run(request).await,
    }
}

async fn with_headers(request: Request, next: Next) -> Response {
    let mut response = next.run(request).await;
    let headers = [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ];
    response.headers_mut().extend(headers.map(|(name, value)| (name, HeaderValue::from_static(value))));
    response
}

fn file(path: &str) -> Response {
    match page::file(path) {
        Some((kind, bytes)) => ([(header::CONTENT_TYPE, kind)], bytes).into_response(),
        None => refused(StatusCode::NOT_FOUND, "the page has no such file"),
    }
}

async fn state(State(shared): State<Arc<ServerState>>) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], shared.session.state()).into_response()
}

/// A part of the drawing.
async fn part(State(shared): State<Arc<ServerState>>, request: Request) -> Response {
    let (session, path) = (shared.session.clone(), below_token(&request));
    replied(tokio::task::spawn_blocking(move || session.part(&path)).await)
}

/// The path of a request below the token.
fn below_token(request: &Request) -> String {
    request.uri().path().splitn(3, '/').nth(2).unwrap_or_default().to_owned()
}

/// An error as the page reads it.
fn refused(status: StatusCode, message: &str) -> Response {
    (status, [(header::CONTENT_TYPE, "application/json")], json!({ "error": message }).to_string()).into_response()
}

/// Converts the result of a thread into a response.
fn replied(reply: Result<Result<Vec<u8>, Refusal>, tokio::task::JoinError>) -> Response {
    match reply {
        Ok(Ok(bytes)) => ([(header::CONTENT_TYPE, "application/octet-stream")], Body::from(bytes)).into_response(),
        Ok(Err(refusal)) => {
            let status = match refusal {
                Refusal::Missing(_) => StatusCode::NOT_FOUND,
                Refusal::NotReady => StatusCode::SERVICE_UNAVAILABLE,
                Refusal::Unanswerable(_) => StatusCode::UNPROCESSABLE_ENTITY,
            };
            refused(status, &refusal.to_string())
        }
        Err(_) => failed(),
    }
}

fn failed() -> Response {
    refused(StatusCode::INTERNAL_SERVER_ERROR, "Belvedere failed in a way that it should not; please report this")
}

/// True while anybody waits for an answer.
#[derive(Default)]
struct Waiting(AtomicBool);

impl Watcher for Waiting {
    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Stops the work on a question when the browser gives it up.
struct StopWhenDropped(Arc<Waiting>);

impl Drop for StopWhenDropped {
    fn drop(&mut self) {
        self.0.0.store(true, Ordering::Relaxed);
    }
}

/// Answers a question of the scene as it is, or of that with a plan.
async fn ask(State(shared): State<Arc<ServerState>>, request: Request) -> Response {
    let path = below_token(&request);
    match body(request, "application/json", MAX_BYTES).await {
        Ok(body) => in_turn(&shared, path, body).await,
        Err(response) => response,
    }
}

/// Sends the drawing of a file of results.
async fn results(State(shared): State<Arc<ServerState>>, request: Request) -> Response {
    in_turn(&shared, below_token(&request), Bytes::new()).await
}

/// Takes a mesh file for plans.
async fn plan_mesh(
    State(shared): State<Arc<ServerState>>,
    Path((_, name)): Path<(String, String)>,
    request: Request,
) -> Response {
    match body(request, "application/octet-stream", MAX_MESH_BYTES).await {
        Ok(body) => in_turn(&shared, format!("plan-meshes/{name}"), body).await,
        Err(response) => response,
    }
}

/// The body of a request of one type, which forms of other pages cannot send.
async fn body(request: Request, kind: &str, max: usize) -> Result<Bytes, Response> {
    let is_kind =
        request.headers().get(header::CONTENT_TYPE).is_some_and(|own| own.as_bytes().starts_with(kind.as_bytes()));
    if !is_kind {
        return Err(refused(StatusCode::UNSUPPORTED_MEDIA_TYPE, &format!("this must be sent as {kind}")));
    }
    match tokio::time::timeout(PATIENCE, axum::body::to_bytes(request.into_body(), max)).await {
        Ok(Ok(body)) => Ok(body),
        Ok(Err(_)) => Err(refused(
            StatusCode::PAYLOAD_TOO_LARGE,
            &format!("what was sent is too long: the most is {} kB", max >> 10),
        )),
        Err(_) => Err(refused(StatusCode::REQUEST_TIMEOUT, "what was sent took too long to arrive")),
    }
}

/// Asks the session when the turn comes, and stops when nobody waits for it any more.
async fn in_turn(shared: &ServerState, path: String, body: Bytes) -> Response {
    let Ok(_place) = shared.places.try_acquire() else {
        return refused(StatusCode::TOO_MANY_REQUESTS, "too many questions at once; try again");
    };
    let Ok(turn) = Arc::clone(&shared.turn).acquire_owned().await else { return failed() };
    let waiting = Arc::new(Waiting::default());
    let of_work = Arc::clone(&waiting);
    let _stop = StopWhenDropped(waiting);
    let session = shared.session.clone();
    let work = move || {
        let reply = session.ask(&path, &body, &Control::new(&*of_work));
        drop(turn);
        reply
    };
    replied(tokio::task::spawn_blocking(work).await)
}
