//! Hostile requests: each is refused or answered without harm, and the page is available afterwards as before.

use belvedere::PointCloud;
use belvedere::control::Control;
use belvedere::model::{ModelParams, OrientBy, SceneModel};
use belvedere_viewer::{PageServer, ViewerParams};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

/// A viewer of rough ground with a step, 20 m wide.
fn viewer() -> PageServer {
    let mut coordinates = Vec::new();
    for x in 0..40 {
        for y in 0..40 {
            let height = if x > 20 { 3.0 } else { 0.0 } + f64::from((x + y) % 2) * 0.1;
            coordinates.push([f64::from(x) * 0.5, f64::from(y) * 0.5, height]);
        }
    }
    let cloud = Arc::new(PointCloud::from_coordinates(&coordinates).0);
    let viewer = PageServer::start(&ViewerParams::default()).unwrap();
    let loading = viewer.loading();
    loading.show(&cloud);
    let params = ModelParams::default().with_orient(OrientBy::Up);
    loading.finish(SceneModel::build(&cloud, &params, &Control::none()).unwrap().0);
    viewer
}

/// Host with port, and token.
fn address(viewer: &PageServer) -> (String, String) {
    let url = viewer.url();
    let (host, token) = url.strip_prefix("http://").unwrap().split_once('/').unwrap();
    (host.to_owned(), token.trim_end_matches('/').to_owned())
}

/// Sends bytes, and gives status and text of the reply; 0 where the server hung up without one.
fn sent(host: &str, request: &[u8]) -> (u16, String) {
    // a thousand at once may be more than the open files that this process is allowed
    let connect = || TcpStream::connect(host).inspect_err(|_| std::thread::sleep(Duration::from_millis(50)));
    let mut stream = (0..200).find_map(|_| connect().ok()).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    // a server that has heard enough closes while we still write
    let _ = stream.write_all(request);
    let mut reply = Vec::new();
    let _ = stream.read_to_end(&mut reply);
    let text = String::from_utf8_lossy(&reply).into_owned();
    (text.get(9..12).and_then(|status| status.parse().ok()).unwrap_or(0), text)
}

fn get(host: &str, path: &str, headers: &str) -> (u16, String) {
    sent(host, format!("GET {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n").as_bytes())
}

fn response(host: &str, token: &str, body: &str) -> (u16, String) {
    let length = body.len();
    let head = format!(
        "POST /{token}/ask/seen HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    );
    sent(host, format!("{head}{body}").as_bytes())
}

fn is_well(host: &str, token: &str) {
    let (status, text) = get(host, &format!("/{token}/state"), &format!("Host: {host}\r\n"));
    assert!(status == 200 && text.contains("point_count"), "{status} {text}");
}

/// Tells whether the server still holds a connection that it has sent nothing to.
fn is_open(stream: &TcpStream) -> bool {
    stream.set_nonblocking(true).unwrap();
    matches!(stream.peek(&mut [0]), Err(error) if error.kind() == ErrorKind::WouldBlock)
}

#[test]
fn only_those_who_know_the_token_and_come_from_the_page_get_answers() {
    let viewer = viewer();
    let (host, token) = address(&viewer);
    let own = format!("Host: {host}\r\n");
    let port = host.split(':').nth(1).unwrap();
    let state = format!("/{token}/state");

    // 1: no token, a wrong one, and one that is right but for its end
    for path in [
        "/",
        "/state",
        &format!("/{}/state", "0".repeat(32)),
        &format!("/{token}0/state"),
        &format!("/{}/state", &token[..31]),
    ] {
        assert_eq!(get(&host, path, &own).0, 403, "{path}");
    }
    // 2: another origin, also one that only begins like ours
    for origin in ["http://evil.example", "null", &format!("http://{host}.evil.example"), &format!("https://{host}")] {
        assert_eq!(get(&host, &state, &format!("{own}Origin: {origin}\r\n")).0, 403, "{origin}");
    }
    // 3: another host: a name that leads here
    for name in ["evil.example", &format!("evil.example:{port}"), "127.0.0.1", "127.0.0.1:1", ""] {
        assert_eq!(get(&host, &state, &format!("Host: {name}\r\n")).0, 403, "{name}");
    }
    assert!([400, 403].contains(&get(&host, &state, "").0), "without any host");
    // 4: paths that leave the page
    for path in [
        "../../../../etc/passwd",
        "..%2f..%2fetc%2fpasswd",
        "%2e%2e/%2e%2e/etc/passwd",
        "page.js/../../Cargo.toml",
        "points/../state",
        "points/-1",
        "points/999999",
        "points/99999999999999999999999",
    ] {
        let (status, text) = get(&host, &format!("/{token}/{path}"), &own);
        assert!((400..500).contains(&status) && !text.contains("root:"), "{path}: {status} {text}");
    }
    // what is ours is delivered, with a policy that keeps others out
    let (status, text) = get(&host, &format!("/{token}/"), &format!("{own}Origin: http://localhost:{port}\r\n"));
    assert_eq!(status, 200);
    let head = text.to_lowercase();
    assert!(
        head.contains("content-security-policy: default-src 'self'")
            && head.contains("nosniff")
            && head.contains("no-referrer")
    );
    is_well(&host, &token);
}

#[test]
fn huge_false_and_slow_requests_do_no_harm() {
    let viewer = viewer();
    let (host, token) = address(&viewer);
    let own = format!("Host: {host}\r\n");

    // 5: a body of 50 MB, and one that only claims to be
    let huge = format!("{{\"place\":[{}1]}}", "1,".repeat(25_000_000));
    let (status, _) = response(&host, &token, &huge);
    assert!(status == 413 || status == 0, "{status}");
    let head = format!(
        "POST /{token}/ask/seen HTTP/1.1\r\n{own}Content-Type: application/json\r\nContent-Length: 99999999999\r\nConnection: close\r\n\r\n{{}}"
    );
    let mut stream = TcpStream::connect(&host).unwrap();
    stream.write_all(head.as_bytes()).unwrap();
    drop(stream);
    // 6: numbers that are none
    for body in [
        "{\"place\":[NaN,0,0]}",
        "{\"place\":[1e999,0,0]}",
        "{\"place\":[null,0,0]}",
        "{\"place\":[\"a\",0,0]}",
        "{\"place\":[0,0]}",
        "",
        "[",
        "\u{0}",
    ] {
        let (status, text) = response(&host, &token, body);
        assert!(status == 422 && text.contains("error"), "{body}: {status} {text}");
    }
    let (status, text) = response(&host, &token, "{\"place\":[1e300,-1e300,1e300]}");
    assert!(status == 422 && text.contains("outside the cloud"), "{status} {text}");
    // 7: not JSON, as a form of another page would be, and other methods
    let form = format!(
        "POST /{token}/ask/seen HTTP/1.1\r\n{own}Content-Type: text/plain\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{{}}"
    );
    assert_eq!(sent(&host, form.as_bytes()).0, 415);
    let delete = format!("DELETE /{token}/state HTTP/1.1\r\n{own}Connection: close\r\n\r\n");
    assert_eq!(sent(&host, delete.as_bytes()).0, 405);
    // the same for meshes and plans: a mesh that is too large, a form, a broken one, a plan with a million corners, and
    // one that nobody made
    let mesh = |kind: &str, name: &str, body: &str| {
        let length = body.len();
        let head = format!(
            "POST /{token}/plan-meshes/{name} HTTP/1.1\r\n{own}Content-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
        );
        sent(&host, format!("{head}{body}").as_bytes())
    };
    let binary = "application/octet-stream";
    assert!([0, 413].contains(&mesh(binary, "a.obj", &"v 1 2 3\n".repeat(5_000_000)).0));
    assert_eq!(mesh("text/plain", "a.obj", "v 1 2 3").0, 415);
    for name in ["a.obj", "a.ply", "a.json", "a", "..%2F..%2Fetc%2Fpasswd.obj"] {
        let (status, text) = mesh(binary, name, "f 1 2 99999999\n{]");
        assert!(status == 422 && text.contains("error") && !text.contains("root:"), "{name}: {status} {text}");
    }
    let plan = |path: &str, body: &str| {
        let length = body.len();
        let head = format!(
            "POST /{token}/{path} HTTP/1.1\r\n{own}Content-Type: application/json\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
        );
        sent(&host, format!("{head}{body}").as_bytes())
    };
    assert!([0, 413].contains(&plan("ask/plan", &format!("{{\"clear\":[[{}[0,0]]]}}", "[0,0],".repeat(1_000_000))).0));
    for body in
        ["{\"clear\":[[[1e999,0],[1,1],[2,2]]]}", "{\"meshes\":[-1]}", "{\"meshes\":[99]}", "{\"buildings\":[{}]}"]
    {
        assert_eq!(plan("ask/plan", body).0, 422, "{body}");
    }
    assert_eq!(plan("plans/7/ask/seen", "{\"place\":[2,2,1.7]}").0, 422);
    assert_eq!(plan("plans/x/ask/seen", "{}").0, 404);
    // 8: deep nesting, and a head without end
    assert_eq!(response(&host, &token, &"[".repeat(60_000)).0, 422);
    let long = format!("GET /{token}/state HTTP/1.1\r\n{own}X: {}\r\n\r\n", "a".repeat(2_000_000));
    assert!([0, 400, 431].contains(&sent(&host, long.as_bytes()).0));
    // 9: a client that sends a byte a second holds up nobody
    let mut slow = TcpStream::connect(&host).unwrap();
    slow.write_all(b"G").unwrap();
    is_well(&host, &token);
    assert!(is_open(&slow));
    drop(slow);
    is_well(&host, &token);
}

#[test]
fn connections_that_rest_or_crawl_hold_up_nobody() {
    let viewer = viewer();
    let (host, token) = address(&viewer);
    // 300 that send nothing, 300 that stop within the head of a request, and 20 that were answered and stay
    let mut held: Vec<TcpStream> = (0..600).map(|_| TcpStream::connect(&host).unwrap()).collect();
    held.iter_mut().skip(300).for_each(|stream| stream.write_all(b"GET / HT").unwrap());
    for _ in 0..20 {
        let mut stream = TcpStream::connect(&host).unwrap();
        stream.write_all(b"GET /x HTTP/1.1\r\nHost: localhost\r\n\r\n").unwrap();
        held.push(stream);
    }
    // each of these is answered while those that rest are still held: nobody waits until they are given up
    for _ in 0..20 {
        is_well(&host, &token);
    }
    let open = held.iter().filter(|stream| is_open(stream)).count();
    assert!(open > 0);
    drop(held);
    is_well(&host, &token);
}

#[test]
fn hundreds_at_once_are_answered_or_refused_and_the_page_lives_on() {
    const QUESTIONS: usize = 400;
    let viewer = viewer();
    let (host, token) = address(&viewer);
    // 10: four hundred questions, from as many connections: both ends of each fit into the 1024 files that many systems
    // let a program open
    let statuses: Vec<u16> = std::thread::scope(|scope| {
        let ask = |_| scope.spawn(|| response(&host, &token, "{\"place\":[2,2,1.7]}").0);
        let all: Vec<_> = (0..QUESTIONS).map(ask).collect();
        all.into_iter().map(|one| one.join().unwrap()).collect()
    });
    let count = |status: u16| statuses.iter().filter(|&&own| own == status).count();
    assert_eq!(count(200) + count(429), QUESTIONS, "{statuses:?}");
    assert!(count(200) > 0);
    is_well(&host, &token);
}
