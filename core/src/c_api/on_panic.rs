//! What the caller may define.

unsafe extern "C" {
    /// Is called where the library panics: define it to stop motors, to log or to reset. Where the
    /// program defines none, or it returns, the library loops for ever.
    ///
    /// It has to stand in an object file of the program; one in an archive may not be taken. In a
    /// library that was built without `panic-handler` the program's own handler runs instead.
    pub fn sinew_on_panic();
}
