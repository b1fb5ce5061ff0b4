//! Materials as the command line names them: a name, and parameters set one by one.

use jaspe_texture::declare::{Declaration, Value};
use jaspe_texture::{BuildError, Texture};

use crate::arguments::Assignment;
use crate::failure::{Failure, nearest};

/// The material of this name (which is one) with these parameters.
pub fn build(name: &str, set: &[Assignment]) -> Result<Texture, Failure> {
    let declaration = Texture::ALL.iter().find(|declaration| declaration.name == name);
    let declaration = declaration.expect("the parser accepts the names of materials only");
    let mut arguments: Vec<(&str, Value)> = Vec::new();
    for Assignment { key, value } in set {
        let parameter = declaration.parameter(key).ok_or_else(|| unknown(key, declaration))?;
        let value = parameter.parse(value).map_err(|error| refused(name, &error))?;
        arguments.push((parameter.name, value));
    }
    Texture::build(name, &arguments).map_err(|error| refused(name, &error))
}

fn unknown(key: &str, declaration: &Declaration) -> Failure {
    let failure = Failure::new(format!("--set: `{}` has no parameter `{key}`", declaration.name));
    match nearest(key, declaration.parameters.iter().map(|parameter| parameter.name.to_owned())) {
        Some(name) => failure.hint(format!("did you mean `{name}`?")),
        None => failure.hint(format!("`jaspe textures {}` lists its parameters", declaration.name)),
    }
}

fn refused(name: &str, error: &BuildError) -> Failure {
    let hint = format!("`jaspe textures {name}` lists its parameters");
    Failure::new(format!("--set: {error}")).hint(hint)
}
