//! The server: one address of this computer, few connections, and none that waits for ever or for those that rest.

use crate::connections::{AnsweredRequest, Connections};
use crate::guard::Guard;
use crate::loading::Loading;
use crate::routes;
use crate::scene_text::SceneText;
use crate::session::Session;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

/// Connections at once: a browser opens six for each tab. For others, those that rest are ended.
const MAX_CONNECTIONS: usize = 256;
/// Maximum time for the head of a request, and maximum idle time of a connection.
const PATIENCE: Duration = Duration::from_secs(15);
/// Threads that serve; questions have their own.
const THREADS: usize = 2;

/// Parameters of the server of a page.
#[derive(Clone, Debug, Default)]
pub struct ViewerParams {
    /// Port to listen on. Default 0: any that is free.
    pub port: u16,
    /// The scene in the command lines that the page shows.
    pub scene: SceneText,
    /// Title of the page.
    pub title: String,
}

/// A running server. It ends when it is dropped.
#[derive(Debug)]
pub struct PageServer {
    guard: Arc<Guard>,
    loading: Loading,
    runtime: Option<Runtime>,
}

impl PageServer {
    /// Begins to serve a page without a scene on 127.0.0.1.
    ///
    /// # Errors
    /// Errors of the operating system about the port.
    pub fn start(params: &ViewerParams) -> std::io::Result<Self> {
        let mut builder = tokio::runtime::Builder::new_multi_thread();
        let runtime = builder.worker_threads(THREADS).thread_name("belvedere-page").enable_all().build()?;
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, params.port));
        let listener = runtime.block_on(TcpListener::bind(address))?;
        let guard = Arc::new(Guard::new(listener.local_addr()?.port())?);
        let session = Session::new(params.title.clone(), params.scene.clone());
        let loading = session.loading();
        let app = routes::app(Arc::clone(&guard), session);
        runtime.spawn(accept(listener, app));
        Ok(Self { guard, loading, runtime: Some(runtime) })
    }

    /// The address of the page, with its token.
    #[must_use]
    pub fn url(&self) -> String {
        self.guard.url()
    }

    /// Returns the handle that takes the scene.
    #[must_use]
    pub fn loading(&self) -> Loading {
        self.loading.clone()
    }

    /// Opens the page in the default browser.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn open_browser(&self) -> std::io::Result<()> {
        open::that_detached(Path::new(&self.url()))
    }
}

impl Drop for PageServer {
    fn drop(&mut self) {
        // a question under way is left behind: nothing of it is written
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

async fn accept(listener: TcpListener, app: axum::Router) {
    let connections = Arc::new(Connections::default());
    loop {
        let place = Arc::new(connections.place(MAX_CONNECTIONS).await);
        let Ok((stream, _)) = listener.accept().await else {
            // too many open files, perhaps
            drop(place);
            connections.end_one();
            tokio::time::sleep(Duration::from_millis(10)).await;
            continue;
        };
        let (router, own) = (TowerToHyperService::new(app.clone()), Arc::clone(&place));
        let service = service_fn(move |request| {
            let (request_open, answer) = (AnsweredRequest::of(&own), router.call(request));
            async move {
                let answer = answer.await;
                drop(request_open);
                answer
            }
        });
        let task = tokio::spawn(async move {
            let mut server = hyper::server::conn::http1::Builder::new();
            server.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
            // an error means that the client broke off: nobody is left to answer
            let _ = server.serve_connection(TokioIo::new(stream), service).await;
        });
        place.set_task(task.abort_handle());
    }
}
