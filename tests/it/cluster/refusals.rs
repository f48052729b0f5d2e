//! Servers and machines that cannot be used: each gives one line and exit code 1, or 2 for a wrong address, and nothing is lost.

use std::path::Path;

use super::server::{Server, free_port, is_there, worker};
use crate::bad_input::refusal;
use crate::program::{folder, run, snakes};

/// Returns the error lines of a coordinator and of a worker.
pub fn refusals(folder: &Path, flags: &str) -> [String; 2] {
    let evolve = format!("--no-render --population 6 --generations 1 --duration 1 {flags}");
    [evolve, format!("worker {flags}")].map(|arguments| refusal(folder, &arguments, 1))
}

#[test]
fn an_address_without_a_server_and_one_with_a_password_are_refused() {
    let folder = folder();
    let url = format!("nats://127.0.0.1:{}", free_port());
    for line in refusals(folder.path(), &format!("--nats {url}")) {
        let place = url.trim_start_matches("nats://");
        let words = format!(
            "error: {url}: cannot connect: no server answers at {place}; start one with nats-server -js, and check \
             address and firewall"
        );
        assert_eq!(line, words);
    }
    let output = run(folder.path(), "worker --nats nats://ann:secret@127.0.0.1");
    let line = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(line.starts_with("error: --nats is ") && !line.contains("secret"), "{line}");
}

#[test]
fn a_server_without_jetstream_is_refused() {
    let Some(server) = Server::start_with(&[]) else { return };
    for line in refusals(folder().path(), &format!("--nats {}", server.url())) {
        assert!(
            line.ends_with("the server has no JetStream; start it with: nats-server -js"),
            "{line}"
        );
    }
}

#[test]
fn without_the_right_credentials_there_is_no_connection() {
    if !is_there() {
        return;
    }
    let place = folder();
    // The pairs of keys were made for this test.
    let config = place.path().join("server.conf");
    let user = "UDIVNDU75JOXBUGTAN2ENBBEWGMQSW2FNKX4GMAS6P6QINQEEWPUGRNS";
    let text = format!("jetstream {{ }}\nauthorization {{ users = [ {{ nkey: {user} }} ] }}\n");
    std::fs::write(&config, text).expect("written");
    let path = config.to_str().expect("UTF-8");
    let Some(server) = Server::start_with(&["-c", path]) else { return };
    let flags = format!("--nats {}", server.url());
    for line in refusals(place.path(), &flags) {
        assert!(
            line.contains("cannot connect: the server refuses the credentials (--creds FILE)"),
            "{line}"
        );
    }
    let seed = place.path().join("other.nk");
    std::fs::write(&seed, "SUAGUNQAWACRUD3BFTKXSZAGF6E6NLCPZ54QQ42O77J3QGRS42LSZXPIQE\n")
        .expect("written");
    for line in refusals(place.path(), &format!("{flags} --creds {}", seed.display())) {
        assert!(
            line.contains("cannot connect: the server refuses the credentials (--creds FILE)"),
            "{line}"
        );
        assert!(!line.contains("SUAGUNQA"), "{line}");
    }
    let own = place.path().join("own.nk");
    std::fs::write(&own, "SUAAXOCPLOU3VIXXF2F5WQQ5BA7WL5IXAFIA4OQLTQZTGOA46WTXSY7UGE\n")
        .expect("written");
    let listed = run(place.path(), &format!("machines {flags} --creds {}", own.display()));
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    let missing = place.path().join("missing.creds");
    for line in refusals(place.path(), &format!("{flags} --creds {}", missing.display())) {
        assert!(line.contains("missing.creds: cannot be read"), "{line}");
    }
    let text = place.path().join("text.creds");
    std::fs::write(&text, "nothing of that kind\n").expect("written");
    for line in refusals(place.path(), &format!("{flags} --creds {}", text.display())) {
        assert!(line.contains("text.creds: neither credentials nor the seed of an NKey"), "{line}");
    }
}

#[test]
fn a_certificate_that_does_not_fit_is_refused() {
    // The files were made for this test: an authority, another authority, and a server's certificate that the first one signed.
    let keys = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/cluster/tls");
    let file = |name: &str| format!("{keys}/{name}");
    let (certificate, key) = (file("server.pem"), file("server.key"));
    let tls = ["-js", "--tls", "--tlscert", &certificate, "--tlskey", &key];
    let Some(server) = Server::start_with(&tls) else { return };
    let (place, url) = (folder(), server.url());
    for flags in [format!("--nats {url}"), format!("--nats {url} --tls-ca {}", file("other.pem"))] {
        for line in refusals(place.path(), &flags) {
            assert!(line.contains("cannot connect") && line.contains("UnknownIssuer"), "{line}");
            assert!(line.contains("--tls-ca FILE names the authority"), "{line}");
        }
    }
    for line in refusals(place.path(), &format!("--nats {url} --tls-ca {key}")) {
        assert!(line.ends_with("server.key: has no certificate in PEM format"), "{line}");
    }
    let listed = run(place.path(), &format!("machines --nats {url} --tls-ca {}", file("ca.pem")));
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    drop(server);
    let Some(server) = Server::start() else { return };
    let flags = format!("--nats {} --tls-ca {}", server.url(), file("ca.pem"));
    for line in refusals(place.path(), &flags) {
        assert!(line.ends_with("the server does not use TLS"), "{line}");
    }
}

#[test]
fn a_worker_whose_engine_no_run_uses_ends_and_names_both() {
    let Some(server) = Server::start() else { return };
    let place = folder();
    let mut command = snakes(place.path(), &format!("worker --threads 1 --nats {}", server.url()));
    let worker = command.stderr(std::process::Stdio::piped()).spawn().expect("it starts");
    super::server::tell_of_another_engine(&server);
    let output = worker.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    let last = said.lines().last().expect("a line");
    assert!(last.starts_with("error: run old on computer needs engine 2 on x86-64"), "{last}");
    assert!(last.contains("and this program computes with engine"), "{last}");
}

#[test]
fn hostile_messages_neither_stop_nor_fill_a_worker_or_a_coordinator() {
    let Some(server) = Server::start() else { return };
    let _worker = worker(&server.url());
    let place = folder();
    let arguments =
        "--no-render --preset climb --seed 2 --population 12 --generations 3 --duration 4 --json";
    let local = crate::program::json_lines(folder().path(), arguments);
    let run =
        super::server::Run::start(place.path(), &arguments.replace(" --json", ""), &server.url());
    super::server::attack(&server, if super::faults::rounds() > 1 { 1_000_000 } else { 20_000 });
    assert_eq!(run.hash(), super::server::run_hash(&local));
    let listed = snakes(place.path(), &format!("machines --json --nats {}", server.url())).output();
    let listed = listed.expect("the program starts");
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
}
