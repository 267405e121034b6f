//! What can be requested below the token: the page, its points, and questions.

use crate::guard::Guard;
use crate::loading::Loading;
use crate::page;
use crate::plans::Plans;
use crate::questions::{self, RequestContext};
use crate::replies::{QuestionReply, Refusal, binary, refused};
use crate::scene::PageScene;
use crate::scene_text::SceneText;
use crate::server::ViewerParams;
use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, Path, Request, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use belvedere::control::{Control, Watcher};
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::sync::Semaphore;

/// Most bytes of a question: a polygon with a thousand corners.
const MAX_BYTES: usize = 65_536;
/// Most bytes of a mesh that is loaded.
const MAX_MESH_BYTES: usize = 32 << 20;
/// How long the rest of a request may take.
const PATIENCE: Duration = Duration::from_secs(10);
/// Questions that wait or are answered; more are refused.
const MAX_QUESTIONS: usize = 24;
/// The page may load what is its own, and nothing else; nobody may show it in a frame.
const POLICY: &str = "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// What all requests share.
struct ServerState {
    loading: Loading,
    text: SceneText,
    title: String,
    /// One question at a time has all threads.
    turn: Arc<Semaphore>,
    places: Arc<Semaphore>,
    plans: Arc<Plans>,
}

pub(crate) fn app(guard: Arc<Guard>, loading: Loading, params: &ViewerParams) -> Router {
    let shared = ServerState {
        loading,
        text: params.scene.clone(),
        title: params.title.clone(),
        turn: Arc::new(Semaphore::new(1)),
        places: Arc::new(Semaphore::new(MAX_QUESTIONS)),
        plans: Arc::default(),
    };
    Router::new()
        .route("/{token}/", get(|| async { file("index.html") }))
        .route("/{token}/{file}", get(|Path((_, path)): Path<(String, String)>| async move { file(&path) }))
        .route("/{token}/state", get(state))
        .route("/{token}/points/{chunk}", get(points))
        .route("/{token}/colors/{chunk}", get(colors))
        .route("/{token}/balls", get(balls))
        .route("/{token}/meshes/{mesh}", get(meshes))
        .route("/{token}/results/{file}", get(results))
        .route("/{token}/ask/{question}", post(ask))
        .route("/{token}/plans/{plan}/ask/{question}", post(ask_of_plan))
        .route("/{token}/plan-meshes/{name}", post(plan_mesh))
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

async fn state(State(shared): State<Arc<ServerState>>) -> Json<Value> {
    let now = shared.loading.read();
    let stage = now.stages.current();
    Json(json!({
        "title": shared.title,
        "stage": stage.map_or("", |stage| stage.name),
        "total": stage.map_or(0, |stage| stage.total),
        "done": stage.map_or(0, |stage| stage.done),
        "failure": now.failure,
        "mesh_count": now.meshes.len(),
        "results": now.results.iter().map(|file| file.describe()).collect::<Vec<_>>(),
        "shown": now.shown.map(|shown| shown.description.clone()),
        "scene": now.scene.map(|scene| scene.describe()),
    }))
}

async fn points(State(shared): State<Arc<ServerState>>, Path((_, chunk)): Path<(String, usize)>) -> Response {
    let shown = shared.loading.now().shown;
    off_thread(move || shown.and_then(|shown| shown.chunks.points(chunk, &shown.cloud))).await
}

async fn colors(State(shared): State<Arc<ServerState>>, Path((_, chunk)): Path<(String, usize)>) -> Response {
    let shown = shared.loading.now().shown;
    off_thread(move || shown.and_then(|shown| shown.chunks.colors(chunk, &shown.cloud))).await
}

async fn balls(State(shared): State<Arc<ServerState>>) -> Response {
    let scene = shared.loading.now().scene;
    off_thread(move || scene.map(|scene| questions::balls(&scene))).await
}

async fn meshes(State(shared): State<Arc<ServerState>>, Path((_, mesh)): Path<(String, usize)>) -> Response {
    let meshes = shared.loading.now().meshes;
    off_thread(move || meshes.get(mesh).map(|mesh| mesh.to_vec())).await
}

async fn off_thread(work: impl FnOnce() -> Option<Vec<u8>> + Send + 'static) -> Response {
    match tokio::task::spawn_blocking(work).await {
        Ok(Some(bytes)) => binary(bytes),
        Ok(None) => refused(StatusCode::NOT_FOUND, "there is no such part of the cloud"),
        Err(_) => failed(),
    }
}

fn failed() -> Response {
    refused(StatusCode::INTERNAL_SERVER_ERROR, "Belvedere failed in a way that it should not; please report this")
}

/// Whether anybody still waits for an answer.
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

async fn ask(state: State<Arc<ServerState>>, Path((_, name)): Path<(String, String)>, request: Request) -> Response {
    answer(state, None, name, request).await
}

async fn ask_of_plan(
    state: State<Arc<ServerState>>,
    Path((_, plan, name)): Path<(String, usize, String)>,
    request: Request,
) -> Response {
    answer(state, Some(plan), name, request).await
}

/// Answers a question of the scene as it is, or of that with a plan.
async fn answer(
    State(shared): State<Arc<ServerState>>,
    plan: Option<usize>,
    name: String,
    request: Request,
) -> Response {
    let body = match body(request, "application/json", MAX_BYTES).await {
        Ok(body) => body,
        Err(response) => return response,
    };
    let (text, plans) = (shared.text.clone(), Arc::clone(&shared.plans));
    in_turn(&shared, move |scene, control| {
        let planned = plan.map(|number| plans.get(number)).transpose()?;
        let (scene, text) = planned.as_ref().map_or((scene, &text), |planned| (&*planned.scene, &planned.text));
        questions::answer(&name, &body, &RequestContext { scene, text, plans: &plans, control })
    })
    .await
}

/// What is drawn of a file of results.
async fn results(State(shared): State<Arc<ServerState>>, Path((_, number)): Path<(String, usize)>) -> Response {
    let Some(file) = shared.loading.now().results.get(number).cloned() else {
        return refused(StatusCode::NOT_FOUND, "there is no such file of results");
    };
    in_turn(&shared, move |scene, control| Ok(file.drawn(scene, control)?)).await
}

/// Takes a mesh file for plans.
async fn plan_mesh(
    State(shared): State<Arc<ServerState>>,
    Path((_, name)): Path<(String, String)>,
    request: Request,
) -> Response {
    let body = match body(request, "application/octet-stream", MAX_MESH_BYTES).await {
        Ok(body) => body,
        Err(response) => return response,
    };
    let plans = Arc::clone(&shared.plans);
    in_turn(&shared, move |scene, control| {
        let number = plans.load(&name, &body, scene.model().frame(), control)?;
        Ok(QuestionReply::of(json!({ "mesh": number, "name": name })))
    })
    .await
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

/// Does work on the scene when its turn comes, and stops when nobody waits for it any more.
async fn in_turn(
    shared: &ServerState,
    work: impl FnOnce(&PageScene, &Control<'_>) -> Result<QuestionReply, Refusal> + Send + 'static,
) -> Response {
    let Some(scene) = shared.loading.now().scene else {
        return refused(StatusCode::SERVICE_UNAVAILABLE, "the scene is not ready yet");
    };
    let Ok(_place) = shared.places.try_acquire() else {
        return refused(StatusCode::TOO_MANY_REQUESTS, "too many questions at once; try again");
    };
    let Ok(turn) = Arc::clone(&shared.turn).acquire_owned().await else { return failed() };
    let waiting = Arc::new(Waiting::default());
    let of_work = Arc::clone(&waiting);
    let _stop = StopWhenDropped(waiting);
    let work = move || {
        let answer = work(&scene, &Control::new(&*of_work));
        drop(turn);
        answer
    };
    match tokio::task::spawn_blocking(work).await {
        Ok(Ok(answer)) => answer.into_response(),
        Ok(Err(refusal)) => refusal.into_response(),
        Err(_) => failed(),
    }
}
