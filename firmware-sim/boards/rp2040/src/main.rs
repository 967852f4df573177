//! RP2040 with Embassy: a walker at the model's rate and a camera's frames, both from flash; what
//! they do goes over the serial line, and the LED is lit while the hand is tracked.
//!
//! A task of its own reads lines and steps the walker between them, so that no angle waits for an
//! arm step of a second.

#![no_std]
#![no_main]

use core::fmt::Write;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_rp::clocks::ClockConfig;
use embassy_rp::gpio::{Level, Output};
use embassy_rp::interrupt;
use embassy_rp::interrupt::{InterruptExt, Priority};
use embassy_rp::uart::{Blocking, Config as UartConfig, UartTx};
use embassy_time::{Duration, Instant, Ticker};
use panic_halt as _;
use sinew_board_tracking::camera::Camera;
use sinew_board_tracking::layout::{HEIGHT, WIDTH};
use sinew_board_tracking::recording::Lines;
use sinew_board_tracking::walker::Walker;
use static_cell::ConstStaticCell;

static WALKER: ConstStaticCell<Walker> = ConstStaticCell::new(Walker::empty());
static CAMERA: ConstStaticCell<Camera> = ConstStaticCell::new(Camera::empty());
static URGENT: InterruptExecutor = InterruptExecutor::new();

/// Frames of the walker a second. Chosen: the worst step, 3.07 million instructions of 1.5 cycles,
/// ends before the next frame, and the mean one, 1.73 million, leaves half of the processor to the
/// arm.
const WALKER_HZ: u64 = 25;
/// Particles of the arm, and most pairs of edge pixels; `docs/firmware_boards.md` has the frames a
/// second of others.
const PARTICLES: usize = 10;
const MAX_PAIRS: usize = 100;

#[interrupt]
unsafe fn SWI_IRQ_1() {
    // SAFETY: the executor was started on this interrupt.
    unsafe { URGENT.on_interrupt() }
}

/// The walker, in an interrupt of its own: it breaks into the arm's step.
#[embassy_executor::task]
async fn walk(walker: &'static mut Walker) {
    let mut ticker = Ticker::every(Duration::from_hz(WALKER_HZ));
    loop {
        ticker.next().await;
        let _ = walker.step();
    }
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let mut config = embassy_rp::config::Config::default();
    // The highest that the data sheet allows.
    if let Ok(clocks) = ClockConfig::system_freq(133_000_000) {
        config.clocks = clocks;
    }
    let board = embassy_rp::init(config);
    let mut led = Output::new(board.PIN_25, Level::Low);
    let mut serial: UartTx<'_, Blocking> = UartTx::new_blocking(board.UART0, board.PIN_0, UartConfig::default());
    let (walker, camera) = (WALKER.take(), CAMERA.take());
    if walker.begin().is_err() || camera.begin((WIDTH as u16, HEIGHT as u16), PARTICLES, MAX_PAIRS).is_err() {
        let _ = serial.blocking_write(b"a tracker does not begin\r\n");
        return;
    }
    interrupt::SWI_IRQ_1.set_priority(Priority::P2);
    if let Ok(task) = walk(walker) {
        URGENT.start(interrupt::SWI_IRQ_1).spawn(task);
    }
    let mut lines = Lines::new();
    loop {
        let begun = Instant::now();
        let mut pixels = [0; WIDTH];
        for row in 0..HEIGHT {
            lines.read(&mut pixels);
            camera.line(row, &pixels);
        }
        let Some(arm) = camera.end(begun.as_micros()) else { continue };
        led.set_level(if arm.candidate.is_some() { Level::High } else { Level::Low });
        let hand = arm.joints.hand_m;
        let mut text = Text::default();
        let millimetres = [hand.x, hand.y, hand.z].map(|metres| (1000.0 * metres) as i32);
        let _ = write!(text, "{:?} mm in {} ms\r\n", millimetres, begun.elapsed().as_millis());
        let _ = serial.blocking_write(text.bytes());
    }
}

/// A line of text; what does not fit is cut.
struct Text {
    bytes: [u8; 64],
    length: usize,
}

impl Default for Text {
    fn default() -> Self {
        Self { bytes: [0; 64], length: 0 }
    }
}

impl Text {
    fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        for (place, byte) in self.bytes.iter_mut().skip(self.length).zip(text.bytes()) {
            *place = byte;
            self.length += 1;
        }
        Ok(())
    }
}
