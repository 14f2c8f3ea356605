//! Converts errors to the exceptions of `endat.errors`.

use endat_host::HostError;
use pyo3::prelude::*;
use pyo3::types::PyType;

/// Python exception.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// `EndatError`: the link is lost, or the answer does not come from a card.
    Link,
    /// `BadInput`: a wrong name or number from the user.
    BadInput,
    /// `Refused`: the encoder, the line or the card rejected the request.
    Refused,
    /// `Silent`: no answer.
    Silent,
}

/// An error and its text.
#[derive(Debug)]
pub struct Fault {
    kind: Kind,
    text: String,
}

impl Fault {
    /// A fault with this text.
    pub fn new(kind: Kind, text: impl Into<String>) -> Self {
        Self {
            kind,
            // Options of the program are arguments here.
            text: text.into().replace("--", ""),
        }
    }
}

impl From<HostError> for Fault {
    fn from(error: HostError) -> Self {
        let kind = match error {
            HostError::Link { .. } | HostError::NoCard(_) => Kind::Link,
            HostError::Name(_) => Kind::BadInput,
            HostError::Part { .. } | HostError::Refused(_) => Kind::Refused,
            HostError::Silent { .. } | HostError::NoSample { .. } => Kind::Silent,
        };
        Self::new(kind, error.to_string())
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        let name = match fault.kind {
            Kind::Link => "EndatError",
            Kind::BadInput => "BadInput",
            Kind::Refused => "Refused",
            Kind::Silent => "Silent",
        };
        Python::attach(|py| {
            let class = py.import("endat.errors").and_then(|m| m.getattr(name));
            match class.and_then(|c| Ok(c.cast_into::<PyType>()?)) {
                Ok(class) => PyErr::from_type(class, fault.text),
                Err(error) => error,
            }
        })
    }
}
