//! STM32F407 with Embassy: a camera's frames of 160 x 120 pixels come through the DCMI into one of
//! two buffers, while the lines of the other go through the front end and the arm steps.

#![no_std]
#![no_main]

use embassy_executor::Spawner;
use embassy_futures::join::join;
use embassy_stm32::dcmi::{self, Dcmi};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::peripherals::{DCMI, DMA2_CH1};
use embassy_stm32::time::Hertz;
use embassy_stm32::{bind_interrupts, dma, rcc};
use embassy_time::Instant;
use panic_halt as _;
use sinew_board_tracking::camera::{Camera, PARTICLES};
use sinew_board_tracking::walker::Walker;
use static_cell::ConstStaticCell;

/// Size of a frame: two of them fit the memory that the DMA reaches.
const WIDTH: usize = 160;
const HEIGHT: usize = 120;
/// Words of a frame, two pixels of RGB565 each.
const WORDS: usize = WIDTH * HEIGHT / 2;
/// Most pairs of edge pixels of a limb; the default of the arm's options.
const MAX_PAIRS: usize = 1000;

static CAMERA: ConstStaticCell<Camera> = ConstStaticCell::new(Camera::empty());
static WALKER: ConstStaticCell<Walker> = ConstStaticCell::new(Walker::empty());
static FRAMES: ConstStaticCell<[[u32; WORDS]; 2]> = ConstStaticCell::new([[0; WORDS]; 2]);

bind_interrupts!(struct Interrupts {
    DCMI => dcmi::InterruptHandler<DCMI>;
    DMA2_STREAM1 => dma::InterruptHandler<DMA2_CH1>;
});

/// 168 MHz from the board's crystal of 8 MHz.
fn clocks() -> rcc::Config {
    let mut clocks = rcc::Config::new();
    clocks.hse = Some(rcc::Hse { freq: Hertz(8_000_000), mode: rcc::HseMode::Oscillator });
    clocks.pll_src = rcc::PllSource::HSE;
    clocks.pll = Some(rcc::Pll {
        prediv: rcc::PllPreDiv::DIV4,
        mul: rcc::PllMul::MUL168,
        divp: Some(rcc::PllPDiv::DIV2),
        divq: Some(rcc::PllQDiv::DIV7),
        divr: None,
    });
    clocks.ahb_pre = rcc::AHBPrescaler::DIV1;
    clocks.apb1_pre = rcc::APBPrescaler::DIV4;
    clocks.apb2_pre = rcc::APBPrescaler::DIV2;
    clocks.sys = rcc::Sysclk::PLL1_P;
    clocks
}

/// The lines of a frame, blobs, edges, arm; the walker goes one frame on.
async fn track(camera: &mut Camera, walker: &mut Walker, frame: &[u32; WORDS], led: &mut Output<'_>) {
    for (row, words) in frame.chunks_exact(WIDTH / 2).enumerate() {
        let mut pixels = [0; WIDTH];
        for (pair, word) in pixels.chunks_exact_mut(2).zip(words) {
            let [low, high, low_next, high_next] = word.to_le_bytes();
            pair.copy_from_slice(&[u16::from_be_bytes([low, high]), u16::from_be_bytes([low_next, high_next])]);
        }
        camera.line(row, &pixels);
    }
    let _ = walker.step();
    let is_seen = camera.end(Instant::now().as_micros()).is_some_and(|arm| arm.candidate.is_some());
    led.set_level(if is_seen { Level::High } else { Level::Low });
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let mut config = embassy_stm32::Config::default();
    config.rcc = clocks();
    let board = embassy_stm32::init(config);
    let mut led = Output::new(board.PD12, Level::Low, Speed::Low);
    let mut eye = Dcmi::new_8bit(
        board.DCMI,
        board.DMA2_CH1,
        Interrupts,
        board.PC6,
        board.PC7,
        board.PE0,
        board.PE1,
        board.PE4,
        board.PB6,
        board.PE5,
        board.PE6,
        board.PB7,
        board.PA4,
        board.PA6,
        dcmi::Config::default(),
    );
    let (camera, walker) = (CAMERA.take(), WALKER.take());
    let [filling, full] = FRAMES.take();
    let (mut filling, mut full) = (filling, full);
    if camera.begin((WIDTH as u16, HEIGHT as u16), PARTICLES, MAX_PAIRS).is_err() || walker.begin().is_err() {
        return;
    }
    loop {
        // The DMA works while the processor tracks the frame before.
        let (captured, ()) = join(eye.capture(filling), track(camera, walker, full, &mut led)).await;
        if captured.is_ok() {
            core::mem::swap(&mut filling, &mut full);
        }
    }
}
