//! Scene: loader, shapes, materials, media, emitters, sensor, and the plan of a run.
