//! What means something to another process only: its keys, and rings.
//!
//! Its keys are refused when they are written and left out when they are not: a key that does nothing would be read as
//! one that does.

use super::problems::Problems;
use super::process::SceneProcess;
use super::table::KeyTable;
use super::values::Values;

/// Reports written keys that are not in the scene's `own` table, and drops what was filled in for others.
pub(super) fn refuse_foreign(
    values: &mut Values,
    process: &SceneProcess,
    own: &KeyTable,
    table: &KeyTable,
    problems: &mut Problems<'_>,
) {
    if own.knows("gear.kind") {
        refuse_ring(values, process, table, problems);
    }
    let foreign = |path: &str| !own.knows(&general(path));
    let mut sections: Vec<&String> = values.sections.keys().filter(|path| foreign(path)).collect();
    // A foreign section is reported once, not with everything inside it.
    let all = sections.clone();
    sections.retain(|path| !all.iter().any(|outer| path.starts_with(&format!("{outer}."))));
    let keys = values.written.iter().filter(|path| foreign(path));
    let keys = keys.filter(|path| !sections.iter().any(|outer| path.starts_with(&format!("{outer}."))));
    let blamed: Vec<String> = sections.iter().copied().chain(keys).cloned().collect();
    for path in blamed {
        let path_in_table = general(&path);
        let others = table.processes().iter().filter(|other| other.name != process.name);
        let owners: Vec<&&SceneProcess> =
            others.filter(|other| KeyTable::new(&[other]).knows(&path_in_table)).collect();
        if owners.is_empty() {
            continue;
        }
        let named = |name: &dyn Fn(&SceneProcess) -> String, joint: &str| {
            owners.iter().map(|owner| name(owner)).collect::<Vec<_>>().join(joint)
        };
        // Another tool is no way out where it does not come into the ring.
        let tools: Vec<String> = owners
            .iter()
            .filter(|owner| !is_ring(values) || owner.cuts_rings)
            .map(|owner| owner.tool_header())
            .collect();
        let senseless = process.senseless.iter().find(|senseless| senseless.holds(&path_in_table));
        problems.add(
            &values.place_of(&path),
            format!(
                "`{}` belongs to {}; this scene is for {}{}",
                path_in_table.replace("[]", ""),
                named(&|owner| owner.name.to_string(), " and "),
                process.name,
                senseless.map_or(String::new(), |senseless| format!(", where {}", senseless.why))
            ),
            match (senseless.map_or("remove it", |senseless| senseless.instead), tools.is_empty()) {
                (instead, true) => instead.to_owned(),
                (instead, false) => {
                    format!("{instead}, or write {} instead of {}", tools.join(" or "), process.tool_header())
                }
            },
        );
    }
    values.held.retain(|path, _| !foreign(path));
    values.variants.retain(|path, _| !foreign(path));
}

/// `operation.0.infeed` as the table of keys has it: `operation[].infeed`.
fn general(path: &str) -> String {
    let mut out = String::new();
    for name in path.split('.') {
        if !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_digit()) {
            out.push_str("[]");
        } else {
            out.push_str(if out.is_empty() { "" } else { "." });
            out.push_str(name);
        }
    }
    out
}

fn is_ring(values: &Values) -> bool {
    values.view("gear").text("kind") == Some("internal")
}

/// Reports a ring that the tool does not come into.
fn refuse_ring(values: &Values, process: &SceneProcess, table: &KeyTable, problems: &mut Problems<'_>) {
    if process.cuts_rings || !is_ring(values) {
        return;
    }
    let others = table.processes().iter().filter(|other| other.cuts_rings);
    let tools: Vec<String> = others.map(|other| other.tool_header()).collect();
    problems.add(
        &values.place_of("gear.kind"),
        format!("`gear.kind`: {} cuts external gears; it does not fit into a ring", process.tool_words),
        format!("write kind = \"external\", or cut the ring with {}", tools.join(" or ")),
    );
}
