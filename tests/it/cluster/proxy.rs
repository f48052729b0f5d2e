//! A connection that can be cut: bytes are held back as by an unplugged network cable, and neither side is notified.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::SeqCst;
use std::time::Duration;

/// Forwards connections to a server, except while it is cut.
pub struct Proxy {
    pub port: u16,
    is_cut: Arc<AtomicBool>,
}

impl Proxy {
    /// Starts a proxy for the server at a port of this machine.
    pub fn to(port: u16) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
        let own = listener.local_addr().expect("an address").port();
        let is_cut = Arc::new(AtomicBool::new(false));
        let cut = Arc::clone(&is_cut);
        std::thread::spawn(move || {
            for client in listener.incoming() {
                let Ok(client) = client else { return };
                // While the network is cut, a new connection is accepted but receives nothing.
                let cut = Arc::clone(&cut);
                std::thread::spawn(move || forward(client, port, &cut));
            }
        });
        Self { port: own, is_cut }
    }

    pub fn url(&self) -> String {
        format!("nats://127.0.0.1:{}", self.port)
    }

    /// Cuts the network (`true`), or repairs it (`false`).
    pub fn cut(&self, is_cut: bool) {
        self.is_cut.store(is_cut, SeqCst);
    }
}

fn forward(client: TcpStream, port: u16, cut: &Arc<AtomicBool>) {
    wait_while_cut(cut);
    let Ok(server) = TcpStream::connect(("127.0.0.1", port)) else { return };
    let Ok(back) = client.try_clone() else { return };
    let Ok(answers) = server.try_clone() else { return };
    let of_answers = Arc::clone(cut);
    std::thread::spawn(move || copy(answers, back, &of_answers));
    copy(client, server, cut);
}

fn copy(mut from: TcpStream, mut to: TcpStream, cut: &AtomicBool) {
    let mut buffer = [0; 16 * 1024];
    while let Ok(length) = from.read(&mut buffer) {
        wait_while_cut(cut);
        if length == 0 || to.write_all(&buffer[..length]).is_err() {
            break;
        }
    }
    let _ = to.shutdown(std::net::Shutdown::Both);
    let _ = from.shutdown(std::net::Shutdown::Both);
}

fn wait_while_cut(cut: &AtomicBool) {
    while cut.load(SeqCst) {
        std::thread::sleep(Duration::from_millis(10));
    }
}
