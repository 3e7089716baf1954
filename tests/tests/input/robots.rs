//! Robot files as people have them: each of these is accepted with the dynamics that an outside oracle gives, or refused
//! with a message that names the line.

mod accepted;
mod case;
mod refused;
