//! A server, workers and coordinators as separate processes.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use futures_util::StreamExt;
use serde_json::Value;

use crate::program::{folder, json_of, run, snakes};

/// A process that is killed when it is dropped.
pub struct Process(pub Child);

impl Process {
    /// Sends a signal, such as `-STOP`.
    pub fn signal(&self, signal: &str) {
        let id = self.0.id().to_string();
        let status = Command::new("kill").args([signal, &id]).status();
        assert!(status.expect("kill starts").success(), "kill {signal} {id}");
    }

    /// Returns how the process ended; `None` while it runs.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.0.try_wait().expect("a state")
    }

    /// Waits for the end of the process, for at most `limit`; `what` names it in the failure message.
    pub fn end_within(&mut self, limit: Duration, what: &str) -> ExitStatus {
        let began = Instant::now();
        loop {
            if let Some(status) = self.ended() {
                return status;
            }
            assert!(began.elapsed() < limit, "{what} goes on");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A `nats-server` with a folder of its own.
pub struct Server {
    process: Option<Process>,
    pub port: u16,
    folder: tempfile::TempDir,
    arguments: Vec<String>,
}

/// Writes a line to standard error, even if the test passes.
pub fn say(line: &str) {
    // The test does not depend on the line.
    let _ = std::io::stderr().write_all(format!("{line}\n").as_bytes());
}

/// Returns a port that was free a moment ago.
pub fn free_port() -> u16 {
    let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    listener.local_addr().expect("an address").port()
}

/// Returns whether `nats-server` is installed. If not, prints a line, or fails if the server is required.
pub fn is_there() -> bool {
    let found = Command::new("nats-server").arg("--version").output().is_ok();
    let is_required = std::env::var_os("SNAKES_CLUSTER_TESTS").is_some_and(|it| it == "required");
    assert!(found || !is_required, "nats-server is not installed");
    if !found {
        say("skipped: nats-server is not installed");
    }
    found
}

impl Server {
    /// Starts a server with JetStream, if `nats-server` is installed.
    pub fn start() -> Option<Self> {
        Self::start_with(&["-js"])
    }

    /// Starts a server that stores at most 8 MB, if `nats-server` is installed.
    pub fn start_small() -> Option<Self> {
        Self::start_as("jetstream { max_file_store: 8MB }")
    }

    /// Starts a server with these settings, if `nats-server` is installed.
    pub fn start_as(settings: &str) -> Option<Self> {
        let mut server = Self::start_with(&["-js"])?;
        server.change(settings);
        Some(server)
    }

    /// Starts the server again with these settings, and with the files of its earlier start.
    pub fn change(&mut self, settings: &str) {
        let config = self.folder.path().join("server.conf");
        std::fs::write(&config, settings).expect("written");
        self.arguments = vec!["-c".to_owned(), config.to_string_lossy().into_owned()];
        self.kill();
        self.restart();
    }

    /// Starts a server with these arguments, if `nats-server` is installed.
    pub fn start_with(arguments: &[&str]) -> Option<Self> {
        if !is_there() {
            return None;
        }
        let arguments = arguments.iter().map(|argument| (*argument).to_owned()).collect();
        let mut server = Self { process: None, port: free_port(), folder: folder(), arguments };
        server.restart();
        Some(server)
    }

    /// Starts the server, with the files of its earlier start if there was one.
    pub fn restart(&mut self) {
        let mut command = Command::new("nats-server");
        command.args(&self.arguments).args([
            "-a",
            "127.0.0.1",
            "-p",
            &self.port.to_string(),
            "-sd",
        ]);
        command.arg(self.folder.path()).stdout(Stdio::null()).stderr(Stdio::null());
        self.process = Some(Process(command.spawn().expect("the server starts")));
        let began = Instant::now();
        while TcpStream::connect(("127.0.0.1", self.port)).is_err() {
            assert!(began.elapsed() < Duration::from_secs(20), "the server answers");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Takes the only connection of a server that allows one.
    ///
    /// A connection that ended a moment ago, such as that of [`Self::restart`], can still count on the server. It then refuses the next
    /// one right after its greeting.
    pub fn take_only_connection(&self) -> TcpStream {
        let began = Instant::now();
        loop {
            let mut taken = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
            taken.set_read_timeout(Some(Duration::from_millis(500))).expect("a timeout");
            let (mut said, mut buffer) = (Vec::new(), [0; 4096]);
            while let Ok(length @ 1..) = taken.read(&mut buffer) {
                said.extend_from_slice(&buffer[..length]);
            }
            let said = String::from_utf8_lossy(&said);
            if said.starts_with("INFO ") && !said.contains("-ERR") {
                return taken;
            }
            assert!(began.elapsed() < Duration::from_secs(20), "no connection: {said}");
        }
    }

    /// Kills the server, as a power failure would.
    pub fn kill(&mut self) {
        self.process = None;
    }

    /// Kills the server and removes its store, as after a restart of a machine with a temporary file system.
    pub fn lose_store(&mut self) {
        self.kill();
        std::fs::remove_dir_all(self.folder.path().join("jetstream")).expect("removed");
    }

    /// Ends the server in an orderly way.
    pub fn stop(&mut self) {
        if let Some(mut process) = self.process.take() {
            process.signal("-TERM");
            process.0.wait().expect("it ends");
        }
    }

    /// Suspends the server, or lets it continue. A suspended server keeps its connections but does not answer.
    pub fn freeze(&self, is_frozen: bool) {
        let process = self.process.as_ref().expect("it runs");
        process.signal(if is_frozen { "-STOP" } else { "-CONT" });
    }

    pub fn url(&self) -> String {
        format!("nats://127.0.0.1:{}", self.port)
    }
}

/// Starts a worker with one thread.
pub fn worker(url: &str) -> Process {
    let folder = std::env::temp_dir();
    let mut command = snakes(&folder, &format!("worker --nats {url} --threads 1"));
    let quiet = command.stdout(Stdio::null()).stderr(Stdio::null()).stdin(Stdio::null());
    Process(quiet.spawn().expect("the worker starts"))
}

/// A worker whose messages are read while it works.
pub struct TellingWorker {
    pub process: Process,
    stderr: Pipe,
}

impl TellingWorker {
    /// Waits until one of the messages contains these words.
    pub fn wait_for(&self, words: &str) {
        self.stderr.wait_for(words);
    }

    /// Waits for the end of the worker, and returns its messages.
    pub fn said(self) -> String {
        String::from_utf8(self.stderr.whole()).expect("UTF-8")
    }
}

/// Starts a worker with one thread whose messages can be read.
pub fn worker_that_tells(url: &str) -> TellingWorker {
    let folder = std::env::temp_dir();
    let mut command = snakes(&folder, &format!("worker --nats {url} --threads 1"));
    let piped = command.stdout(Stdio::null()).stderr(Stdio::piped()).stdin(Stdio::null());
    let mut child = piped.spawn().expect("the worker starts");
    let stderr = Pipe::read(child.stderr.take().expect("piped"));
    TellingWorker { process: Process(child), stderr }
}

/// Waits until the list of the server's machines is as wanted, for at most a minute.
pub fn wait_for_list(server: &Server, flags: &str, is_wanted: impl Fn(&str) -> bool) {
    let began = Instant::now();
    loop {
        let listed =
            run(&std::env::temp_dir(), &format!("machines --nats {} {flags}", server.url()));
        let listed = String::from_utf8(listed.stdout).expect("UTF-8");
        if is_wanted(&listed) {
            return;
        }
        assert!(began.elapsed() < Duration::from_mins(1), "{listed}");
    }
}

/// Waits until this number of workers is ready for work.
pub fn wait_for_workers(server: &Server, count: usize) {
    wait_for_list(server, "--json", |list| {
        list.lines().filter(|line| line.contains("\"type\":\"worker\"")).count() == count
    });
}

/// A pipe that is read while its process runs, so that it never fills.
struct Pipe {
    bytes: Arc<Mutex<Vec<u8>>>,
    reader: JoinHandle<()>,
}

impl Pipe {
    fn read(mut pipe: impl Read + Send + 'static) -> Self {
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let all = Arc::clone(&bytes);
        let reader = std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(length @ 1..) = pipe.read(&mut buffer) {
                all.lock().expect("no panic").extend_from_slice(&buffer[..length]);
            }
        });
        Self { bytes, reader }
    }

    /// Returns the number of lines read so far.
    fn lines(&self) -> usize {
        self.bytes.lock().expect("no panic").iter().filter(|byte| **byte == b'\n').count()
    }

    /// Waits until the text read so far contains these words, for at most a minute.
    fn wait_for(&self, words: &str) {
        let began = Instant::now();
        loop {
            let said = String::from_utf8_lossy(&self.bytes.lock().expect("no panic")).into_owned();
            if said.contains(words) {
                return;
            }
            assert!(began.elapsed() < Duration::from_mins(1), "waited for {words:?}\n{said}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Returns all bytes, after the end of the process.
    fn whole(self) -> Vec<u8> {
        self.reader.join().expect("no panic");
        std::mem::take(&mut *self.bytes.lock().expect("no panic"))
    }
}

/// A running coordinator.
pub struct Run {
    pub folder: PathBuf,
    arguments: String,
    process: Process,
    stdout: Pipe,
    stderr: Pipe,
}

impl Run {
    /// Starts a command as a coordinator on a server.
    pub fn start(folder: &Path, arguments: &str, url: &str) -> Self {
        let arguments = format!("{arguments} --json --nats {url}");
        let (process, stdout, stderr) = spawned(folder, &arguments);
        Self { folder: folder.to_owned(), arguments, process, stdout, stderr }
    }

    /// Waits until this number of generations is finished.
    pub fn wait_for_generations(&mut self, count: usize) {
        let began = Instant::now();
        while self.stdout.lines() < count {
            assert!(self.is_running(), "the run ended before generation {count}");
            assert!(began.elapsed() < Duration::from_mins(5), "waited for generation {count}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until one of the coordinator's messages contains these words.
    pub fn wait_for(&self, words: &str) {
        self.stderr.wait_for(words);
    }

    /// Waits until the coordinator has ended, for at most `limit`.
    pub fn wait_for_end(&mut self, limit: Duration) {
        self.process.end_within(limit, "the run");
    }

    /// Returns whether the coordinator has not ended.
    pub fn is_running(&mut self) -> bool {
        self.process.ended().is_none()
    }

    /// Kills the coordinator and starts it again.
    pub fn restart(&mut self) {
        self.process.0.kill().expect("it can be killed");
        self.process.0.wait().expect("it ends");
        (self.process, self.stdout, self.stderr) = spawned(&self.folder, &self.arguments);
    }

    /// Stops the coordinator with the interrupt key, and returns its standard error.
    pub fn stopped(self) -> String {
        self.process.signal("-INT");
        let output = self.output();
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(1), "{said}");
        said
    }

    /// Waits for the end of the coordinator, and returns its output.
    pub fn output(mut self) -> Output {
        let (stdout, stderr) = (self.stdout.whole(), self.stderr.whole());
        let status = self.process.0.wait().expect("it ends");
        Output { status, stdout, stderr }
    }

    /// Waits for the end of the coordinator, which must be a success, and returns its JSON lines and its messages.
    pub fn finished(self) -> (Vec<Value>, String) {
        let arguments = self.arguments.clone();
        let output = self.output();
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(output.status.success(), "{arguments}: {:?}\n{said}", output.status);
        (json_of(&output.stdout), said)
    }

    /// Waits for the end of the coordinator, and returns the hash of the run.
    pub fn hash(self) -> String {
        run_hash(&self.finished().0)
    }
}

/// Starts a coordinator. Returns the process, its standard output and its standard error.
fn spawned(folder: &Path, arguments: &str) -> (Process, Pipe, Pipe) {
    let mut command = snakes(folder, arguments);
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped()).stdin(Stdio::null());
    let mut child = piped.spawn().expect("the coordinator starts");
    let stdout = Pipe::read(child.stdout.take().expect("piped"));
    let stderr = Pipe::read(child.stderr.take().expect("piped"));
    (Process(child), stdout, stderr)
}

/// Returns the hash of a run from the last of its lines.
pub fn run_hash(lines: &[Value]) -> String {
    let last = lines.last().expect("a line");
    last["run_hash"].as_str().expect("a hash").to_owned()
}

/// Runs `task` with a connection of the test itself to the server.
fn with_server<T>(server: &Server, task: impl AsyncFnOnce(async_nats::Client) -> T) -> T {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    runtime
        .expect("a runtime")
        .block_on(async { task(async_nats::connect(server.url()).await.expect("connected")).await })
}

/// Fills the store of a server up to its limit.
pub fn fill(server: &Server) {
    with_server(server, async |client| {
        let jetstream = async_nats::jetstream::new(client);
        let config = async_nats::jetstream::stream::Config {
            name: "FILLER".to_owned(),
            subjects: vec!["filler".to_owned()],
            ..Default::default()
        };
        jetstream.create_stream(config).await.expect("a stream");
        for length in [500_000, 50_000, 5_000, 500] {
            loop {
                let sent = jetstream.publish("filler", vec![0; length].into()).await;
                let Ok(sent) = sent else { break };
                if sent.await.is_err() {
                    break;
                }
            }
        }
    });
}

/// Removes what [`fill`] stored.
pub fn empty(server: &Server) {
    with_server(server, async |client| {
        let jetstream = async_nats::jetstream::new(client);
        jetstream.delete_stream("FILLER").await.expect("removed");
    });
}

/// Sends this number of messages of every wrong kind to the subjects of the present run and of its workers.
pub fn attack(server: &Server, messages: usize) {
    with_server(server, async |client| {
        let first = async |subject: &'static str| -> Value {
            let mut notices = client.subscribe(subject).await.expect("heard");
            let message = notices.next().await.expect("a notice");
            serde_json::from_slice(&message.payload).expect("JSON")
        };
        let (run, worker) = (first("snakes.run").await, first("snakes.worker").await);
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        let (run, proof) = (text(&run["run"]), text(&run["proof"]));
        let subjects = [
            "snakes.worker".to_owned(),
            "snakes.run".to_owned(),
            format!("snakes.work.{proof}.{run}"),
            format!("snakes.result.{run}"),
            format!("snakes.shared.{run}.0"),
            format!("snakes.audit.{}", text(&worker["worker"])),
        ];
        let result = "{\"format\":1,\"run\":\"R\",\"batch\":1,\"worker\":\"w\",\"elapsed_s\":1,\"keys\":[\"0000000000000000\"]}\n{}";
        let work = "{\"format\":1,\"run\":\"R\",\"batch\":1,\"kind\":\"score\",\"shared\":\"0000000000000000\",\
                    \"keys\":[\"0000000000000000\"]}\n{}";
        let bodies: Vec<Vec<u8>> = vec![
            Vec::new(),
            b"{".to_vec(),
            b"\xff\xfe".to_vec(),
            b"x\x9c\x01\x02\x03".to_vec(),
            b"{\"format\":9}".to_vec(),
            result.replace('R', &run).into_bytes(),
            work.replace('R', &run).into_bytes(),
            vec![b'{'; 900_000],
        ];
        for number in 0..messages {
            let body = &bodies[number % bodies.len()];
            if body.len() > 100_000 && number > 200 {
                continue;
            }
            let subject = subjects[number / bodies.len() % subjects.len()].clone();
            client.publish(subject, body.clone().into()).await.expect("sent");
        }
        client.flush().await.expect("sent");
    });
}

/// Sends notices of a run with another engine for some seconds.
pub fn tell_of_another_engine(server: &Server) {
    let notice = "{\"format\":1,\"run\":\"old\",\"host\":\"computer\",\"engine\":2,\"processors\":\"x86-64\",\
                  \"proof\":\"00000000000000aa\",\"pending\":1,\"results\":0,\"set_aside\":[]}";
    with_server(server, async |client| {
        for _ in 0..16 {
            client.publish("snakes.run", notice.into()).await.expect("sent");
            client.flush().await.expect("sent");
            tokio::time::sleep(Duration::from_millis(500)).await;
        }
    });
}
