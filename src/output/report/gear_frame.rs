//! The frames of the 3D view, the picker and the map.

use super::viewer::Viewer;
use maud::{Markup, html};

/// The 3D view, the picker and the map: empty frames that the scripts fill; with a mate the means to roll, with strokes
/// the means to follow them.
pub fn gear_frame(viewer: &Viewer) -> Markup {
    let turn = |action: &str, words: &str, label: &str| {
        html! {
            button type="button" data-view=(action) title=(label) aria-label=(label) { (words) }
        }
    };
    html! {
        section id="gear" aria-labelledby="gear-title" {
            h2 id="gear-title" { "Gear and maps" }
            noscript { p class="warning" { "The gear and its maps need JavaScript; all numbers and charts below do \
                not." } }
            div class="viewer" {
                div class="stage" {
                    canvas id="gear-view" tabindex="0" role="application"
                        aria-label="The gear in three dimensions" aria-describedby="gear-help" {}
                    canvas id="gear-marks" aria-hidden="true" {}
                    p id="gear-failed" class="warning" hidden { "This browser gives no WebGL 2: the gear cannot be \
                        drawn. Maps and charts work without it." }
                    div class="stage-tools" role="toolbar" aria-label="View" {
                        (turn("home", "Home", "View from above, the whole gear"))
                        (turn("front", "Face", "View along the axis"))
                        (turn("flank", "Flank", "View of the picked flank"))
                        (turn("closer", "+", "Closer"))
                        (turn("further", "−", "Further away"))
                        button type="button" id="tooth-numbers" aria-pressed="true" title="Numbers of the teeth" {
                            "No."
                        }
                        button type="button" id="gear-section" title="Section: across the axis, along it, none" {
                            "Section"
                        }
                    }
                    @if viewer.strokes.is_some() {
                        div class="roll strokes" {
                            button type="button" id="strokes-play" aria-pressed="false" { "Play" }
                            input id="strokes" type="range" min="0" value="0" step="1" aria-label="Stroke of the tool"
                                aria-describedby="stroke-facts";
                            button type="button" id="strokes-work" aria-pressed="true"
                                title="The work as it is then; otherwise the finished gear with its maps" { "Work" }
                            output id="stroke-facts" {}
                        }
                    }
                    @if viewer.mate.is_some() {
                        div class="roll" {
                            button type="button" id="roll-play" aria-pressed="false" { "Roll" }
                            input id="roll" type="range" min="0" value="0" step="1" aria-label="Angle of gear A";
                            output id="roll-angle" {}
                        }
                    }
                    output id="gear-readout" class="readout" aria-live="off" {}
                }
                div class="picker" {
                    label class="field" { span { "Show" } select id="quantity" {} }
                    div class="field" {
                        span id="tooth-label" { "Tooth" }
                        div class="stepper" {
                            button type="button" id="tooth-before" aria-label="Tooth before" { "‹" }
                            input id="tooth" type="number" inputmode="numeric" min="1" step="1"
                                aria-labelledby="tooth-label";
                            button type="button" id="tooth-after" aria-label="Tooth after" { "›" }
                        }
                    }
                    fieldset class="field sides" {
                        legend { "Flank" }
                        label { input type="radio" name="side" value="left" checked; span { "left" } }
                        label { input type="radio" name="side" value="right"; span { "right" } }
                    }
                    div class="field bar" {
                        span id="bar-name" {}
                        canvas id="bar" role="img" aria-labelledby="bar-name" {}
                    }
                    p id="quantity-definition" class="note" {}
                    dl id="flank-numbers" class="flank-numbers" {}
                }
            }
            p id="gear-help" class="note" {
                "Drag to turn; click into the view, then turn the wheel or pinch to come closer; drag with the right \
                button to move. Keys: arrows turn, + and − come closer and go away, Home goes back. A click on a flank \
                picks it. Roots, tips and end faces carry no map: they are grey."
            }
            figure class="chart map" {
                figcaption id="map-title" {}
                canvas id="map" tabindex="0" role="application" aria-labelledby="map-title"
                    aria-describedby="map-help" {}
                div class="x-name" { "v: along the tooth from the middle of the face [mm]" }
                output id="map-readout" class="readout-line" aria-live="polite" {}
                p id="map-help" class="note" { "Point at a place, or move the cross with the arrow keys, to read its \
                    value. Up is u: along the profile from the form point (the root side) to the tip. Dashed: the \
                    ends of what is evaluated." }
            }
            figure class="chart sheet" {
                figcaption { "All flanks, to one scale" }
                div id="sheet" role="listbox" aria-label="All flanks" {}
            }
        }
    }
}
