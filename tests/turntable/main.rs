//! Scenes that luxel makes from meshes: turntables of meshes of every size and form, converted files, and the commands.

mod command;
mod convert;
mod shapes;
mod studio;
mod zoo;
