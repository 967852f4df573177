//! Rules that the project itself keeps: its rooms, docs, help and examples.

mod architecture;
mod book;
mod doc_examples;
mod documentation;
mod formats;
mod help;
mod project_files;
