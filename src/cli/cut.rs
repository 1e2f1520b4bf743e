//! `gearcut cut`: the whole job.
