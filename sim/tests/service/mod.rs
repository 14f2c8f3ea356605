//! Requests, health and initialisation by the service of an encoder port, as seen by a host.

mod health;
mod initialise;
mod limits;
mod long_run;
mod mailbox;
mod plug;
mod rig;
mod three_ways;
mod unplugged;
mod upsets;
mod waiting;
mod waits;
