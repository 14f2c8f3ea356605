//! Requests, health and initialisation by the service of an encoder port, as a host sees them.

mod card;
mod health;
mod initialise;
mod mailbox;
mod rig;
mod three_ways;
