//! The emulated board: MPS2 with a Cortex-M4 or M7 under QEMU.
//!
//! Records go through semihosting, log bytes through UART 0, instructions are read from timer 0. A
//! panic, a fault and a stack overflow end the emulator with a failure.

mod files;
mod logger;
mod registers;
mod stack;
mod stop;

use crate::port::{COSTS_FILE, INPUT_FILE, Part, Port, RESULTS_FILE, put};
use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};
use files::{File, InputFile};
use sinew_record::{Cost, RecordError};

/// The board as images see it.
#[derive(Debug)]
pub struct Board {
    input: InputFile,
    results: File,
    costs: File,
}

impl Port for Board {
    type Input = InputFile;
    type Output = File;

    fn split(&mut self) -> (&mut InputFile, &mut File, &mut File) {
        (&mut self.input, &mut self.results, &mut self.costs)
    }

    fn instructions() -> u32 {
        registers::instructions()
    }
}

/// Runs an image on the board and ends the emulator.
pub fn run(image: fn(&mut Board) -> Result<(), RecordError>) -> ! {
    registers::start();
    stack::guard();
    let code = match play(image) {
        Ok(()) => EXIT_SUCCESS,
        Err(message) => {
            stop::print(message);
            EXIT_FAILURE
        }
    };
    loop {
        exit(code);
    }
}

fn play(image: fn(&mut Board) -> Result<(), RecordError>) -> Result<(), &'static str> {
    let input = InputFile(File::open(INPUT_FILE, false).ok_or("there is no input: run the image by its runner")?);
    let results = File::open(RESULTS_FILE, true).ok_or("the results cannot be written")?;
    let costs = File::open(COSTS_FILE, true).ok_or("the costs cannot be written")?;
    let mut board = Board { input, results, costs };
    image(&mut board).map_err(|_| "the image could not go on")?;
    let worst = stack::most_used_bytes();
    let stack = Cost { frames: 1, total: u64::from(worst), worst, ..Part::Stack.cost(&Cost::zero()) };
    put(&mut board.costs, &stack).map_err(|_| "the costs have no room")?;
    board.input.0.close();
    board.results.close();
    board.costs.close();
    Ok(())
}
