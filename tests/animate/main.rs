//! Animations: the command from outside, what keys and spins do to a world, how noise changes from frame to frame, and
//! that an update gives what a build from nothing gives.

mod command;
mod crowd;
mod folder;
mod gltf;
mod interrupted;
mod level;
mod motion;
mod noise;
mod standing;
#[path = "../support/folder.rs"]
mod support;
