//! How near the trackers come, on drawn and on real recordings. With `-- --nocapture` most print
//! what the book states.

mod arm;
mod arm_spread;
mod body;
mod body_ambiguity;
mod body_clips;
mod body_exchanged_legs;
mod body_first_pose;
mod body_foresight;
mod body_runners;
mod body_size;
mod body_spread;
mod cadence_of_windows;
mod circles;
mod cyclic;
mod cyclic_after_something_else;
mod cyclic_circles;
mod cyclic_cuts;
mod cyclic_hidden_arm;
mod cyclic_long_runs;
mod cyclic_misfit;
mod cyclic_noise_assumed;
mod cyclic_smoothing;
mod cyclic_speeds;
mod cyclic_stress;
mod cyclic_turns;
mod finished_recordings;
mod front_end;
mod hand_likelihood_roc;
mod hand_roc_of_people;
mod particle;
mod people;
mod shared_data;
mod walk_cuts;
