//! Plans by hand: the taut system is differentially flat, with the load's position and the yaw as flat outputs.
