//! The address of a NATS server, and the error message when no connection to it can be made.

use std::path::PathBuf;

use async_nats::{ConnectError, ConnectErrorKind, ServerAddr};

use super::trouble::{Trouble, one_line, said};
use snakes_core::check::Invalid;

/// Address of a NATS server and the files that a connection to it needs.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BrokerOptions {
    /// Address of the server, such as `nats://192.168.1.5:4222`. A cluster of servers has several, separated by commas.
    pub url: String,
    /// File with the credentials: a `.creds` file as `nsc` writes it, or the seed of an NKey. `None` connects without.
    pub creds: Option<PathBuf>,
    /// File with the certificate of the authority that signed the server's certificate. `None` uses the system's.
    pub tls_ca: Option<PathBuf>,
}

impl BrokerOptions {
    /// Checks each address. An address with a password is refused, because other users can read the command line.
    ///
    /// # Errors
    /// An address has the wrong form, or contains a user or a password.
    pub fn check(&self) -> Result<(), Invalid> {
        self.url.split(',').try_for_each(check_address)
    }

    /// Returns the flags that name this server on a command line, to be copied. `FILE` stands for the path of a file.
    pub fn flags(&self) -> String {
        let creds = if self.creds.is_some() { " --creds FILE" } else { "" };
        let tls_ca = if self.tls_ca.is_some() { " --tls-ca FILE" } else { "" };
        format!("--nats {}{creds}{tls_ca}", self.url)
    }

    /// Returns the hosts and ports of the addresses, as they appear in messages.
    fn places(&self) -> String {
        let place = |address: &str| match address.parse::<ServerAddr>() {
            Ok(address) => format!("{}:{}", address.host(), address.port()),
            Err(_) => address.to_owned(),
        };
        self.url.split(',').map(place).collect::<Vec<String>>().join(", ")
    }

    /// Returns why the connection cannot be made, with advice where the reason is a known one.
    pub(super) fn why_unreachable(&self, error: &ConnectError) -> Trouble {
        if let Some(error) = said(error) {
            return Trouble::of_server(error);
        }
        let problem = one_line(error);
        let advice = [
            (
                "UnknownIssuer",
                "--tls-ca FILE names the authority that signed the server's certificate",
            ),
            ("InvalidContentType", "the server does not use TLS"),
        ];
        let places = self.places();
        Trouble::Refused(match advice.into_iter().find(|(word, _)| problem.contains(word)) {
            Some((_, advice)) => format!("{problem}; {advice}"),
            None => match error.kind() {
                ConnectErrorKind::Dns => {
                    format!("no computer is found at {places}; check the name, or give its number")
                }
                ConnectErrorKind::Io | ConnectErrorKind::TimedOut => format!(
                    "no server answers at {places}; start one with nats-server -js, and check address and firewall"
                ),
                _ => problem,
            },
        })
    }
}

fn check_address(address: &str) -> Result<(), Invalid> {
    let refused =
        |shown: &str, allowed: String| Err(Invalid::new("--nats", format!("{shown:?}"), allowed));
    if let Some((_, host)) = address.rsplit_once('@') {
        // The message leaves out the password.
        let allowed =
            "an address without user and password, which others could read (use --creds FILE)";
        return refused(&format!("…@{host}"), allowed.to_owned());
    }
    let form = "nats://HOST:PORT or tls://HOST:PORT";
    let host = address.strip_prefix("nats://").or(address.strip_prefix("tls://"));
    let is_one = |host: &&str| !host.is_empty() && address.parse::<ServerAddr>().is_ok();
    if host.filter(is_one).is_some() {
        return Ok(());
    }
    // Suggests the same host in the right form.
    let host = address.rsplit_once("://").map_or(address, |(_, host)| host);
    let host = host.trim_end_matches('/');
    let better = if host.contains(':') { host.to_owned() } else { format!("{host}:4222") };
    let better = Some(format!("nats://{better}"))
        .filter(|better| !host.is_empty() && better.parse::<ServerAddr>().is_ok());
    refused(address, better.map_or(form.to_owned(), |better| format!("{form}, such as {better}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(url: &str) -> BrokerOptions {
        BrokerOptions { url: url.to_owned(), ..Default::default() }
    }

    #[test]
    fn an_address_with_a_password_is_refused_without_repeating_it() {
        assert_eq!(options("nats://127.0.0.1:4222").check(), Ok(()));
        assert_eq!(options("tls://a:4222,nats://b").check(), Ok(()));
        for url in ["nats://ann:secret@a:4222", "ann:secret@a", "nats://b,nats://secret@a"] {
            let error = options(url).check().expect_err("refused").to_string();
            assert!(error.starts_with("--nats is \"…@a"), "{error}");
            assert!(!error.contains("secret") && error.contains("--creds FILE"), "{error}");
        }
    }

    #[test]
    fn an_address_in_another_form_is_refused_with_the_right_one() {
        for (url, offer) in [
            ("127.0.0.1:24222", ", such as nats://127.0.0.1:24222"),
            ("127.0.0.1", ", such as nats://127.0.0.1:4222"),
            ("http://a:4222/", ", such as nats://a:4222"),
            ("nats://a:b", "tls://HOST:PORT"),
            ("nats://", "tls://HOST:PORT"),
            ("", "tls://HOST:PORT"),
        ] {
            let error = options(url).check().expect_err("refused").to_string();
            let start = format!("--nats is {url:?}; allowed: nats://HOST:PORT or tls://HOST:PORT");
            assert!(error.starts_with(&start) && error.ends_with(offer), "{error}");
        }
    }
}
