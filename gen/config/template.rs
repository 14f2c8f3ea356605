//! Renders the templates of generated text files.

use endat_console::error::CommandError;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Value;
use minijinja::{Environment, UndefinedBehavior};

/// A template with its values filled in; nothing is escaped, and a value that is missing is an error.
pub fn render(name: &str, template: &str, context: &Value) -> Result<String, CommandError> {
    filled(name, template, context).map_err(broken)
}

/// The same with a template that a user has written.
pub fn render_own(name: &str, template: &str, context: &Value) -> Result<String, CommandError> {
    filled(name, template, context)
        .map_err(|error| CommandError::input(format!("{name}: {error}; correct the template")))
}

fn filled(name: &str, template: &str, context: &Value) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let syntax = SyntaxConfig::builder()
        .keep_trailing_newline(true)
        .trim_blocks(true)
        .lstrip_blocks(true)
        .build();
    environment.set_syntax(syntax?);
    // The output is Verilog, UCF and Markdown: nothing is to be escaped for HTML.
    environment.set_auto_escape_callback(|_| minijinja::AutoEscape::None);
    environment.add_template(name, template)?;
    environment
        .get_template(name)
        .and_then(|t| t.render(context))
}

/// A template that does not render is a fault of the program, and still no reason to panic.
fn broken(error: minijinja::Error) -> CommandError {
    CommandError::input(format!(
        "template: {error:#}; this is a fault of this program, please report it"
    ))
}
