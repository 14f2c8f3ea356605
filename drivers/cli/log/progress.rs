//! What is told while a log goes on.

use endat_host::transport::LinkState;
use std::time::Duration;

/// Nothing for this long: something is wrong.
pub const SILENCE: Duration = Duration::from_secs(20);
/// Says so when the link is lost, and when it is back.
pub struct Watch {
    pub last: LinkState,
}

impl Watch {
    /// What is to be told of the link, as it is now.
    pub fn news(&mut self, now: LinkState) -> Vec<String> {
        let before = std::mem::replace(&mut self.last, now);
        let is_lost = before.is_open && (!now.is_open || now.reopened > before.reopened);
        let is_back = now.is_open && now.reopened > before.reopened;
        let lost = format!("connection lost, trying for {} s", SILENCE.as_secs());
        let back = "connection is back".to_owned();
        let both = [(is_lost, lost), (is_back, back)];
        both.into_iter()
            .filter_map(|(is_so, text)| is_so.then_some(text))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_link_is_told_once_and_so_is_its_return() {
        let mut watch = Watch {
            last: LinkState::default(),
        };
        let mut told = |is_open, reopened| watch.news(LinkState { is_open, reopened });
        assert_eq!(told(true, 0), [""; 0]);
        assert_eq!(told(false, 0), ["connection lost, trying for 20 s"]);
        assert_eq!(told(false, 0), [""; 0]);
        assert_eq!(told(true, 1), ["connection is back"]);
        // Lost and back between two looks.
        assert_eq!(told(true, 2).len(), 2);
        assert_eq!(told(true, 2), [""; 0]);
    }
}
