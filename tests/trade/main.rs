//! The trade between speed and accuracy, measured: error bars, stopping by them, and how errors fall with samples.

mod calibration;
mod limits;
mod noise;
mod slopes;
mod stage;
mod truth;
