//! Robot files as people have them: each of these is accepted with the dynamics that an outside oracle gives, or refused
//! with a message that names the line.

#[path = "robots/accepted.rs"]
mod accepted;
#[path = "robots/case.rs"]
mod case;
#[path = "robots/refused.rs"]
mod refused;
