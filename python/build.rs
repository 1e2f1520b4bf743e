//! Libraries for Python leave its symbols open; linkers on macOS ask for a word on that.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
