//! What is logged while a test runs.
use bevy::{
    ecs::schedule::SingleThreadedExecutor,
    log::{
        Level,
        tracing_subscriber::{fmt, util::SubscriberInitExt},
    },
    prelude::*,
    render::RenderApp,
};
use std::{
    io::Write,
    sync::{Arc, Mutex},
};

#[derive(Clone, Default)]
struct Paper(Arc<Mutex<Vec<u8>>>);

impl Write for Paper {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// The warnings and errors that are logged while `app` does what it is told, as lines of text.
pub fn complaints(app: &mut App, act: impl FnOnce(&mut App)) -> Vec<String> {
    run_on_this_thread(app);
    let paper = Paper::default();
    let writer = paper.clone();
    let listener = fmt().with_max_level(Level::WARN).with_ansi(false).without_time();
    let listening = listener.with_writer(move || writer.clone()).set_default();
    act(app);
    drop(listening);
    let text = String::from_utf8(paper.0.lock().unwrap().clone()).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Makes all systems of `app` run on this thread from now on, so that tests that run at the same time do not hear each
/// other: for every test that provokes complaints.
pub fn run_on_this_thread(app: &mut App) {
    fn settle_down(world: &mut World) {
        for (_, schedule) in world.resource_mut::<Schedules>().iter_mut() {
            schedule.set_executor(SingleThreadedExecutor::new());
        }
    }
    settle_down(app.world_mut());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        settle_down(render_app.world_mut());
    }
}
