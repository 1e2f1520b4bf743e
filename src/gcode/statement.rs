//! Blocks as statements: what the words of a block command, and the modes that are in force when it runs.
//!
//! In: words block by block, the letters of a machine's axes, whether it has a ram. Out: a [`Statement`] for each
//! block. Law: a program is read as strictly as the strictest of the controls reads it (`super::post`). Codes are
//! whole numbers, and a block has one word of each modal group at most; a position needs `G21` and `G90` before it, for
//! without them a control runs in whatever was modal before. Everything else is refused by word.
//!
//! Road not taken: the default modes of a control. They are set by parameters of the machine, and no program knows
//! them.

use super::words::{Word, blocks};
use crate::machine::AxisKind;

/// What a machine's programs have words for.
#[derive(Debug, Clone, Copy)]
pub struct Grammar<'a, const N: usize> {
    /// Letter and kind of each axis.
    pub axes: [(char, AxisKind); N],
    /// What the axes are, as a refusal names them.
    pub names: &'a str,
    /// Whether a ram runs beside the axes: S, M3, M5, and dwells in which it goes on.
    pub ram: bool,
    /// Whether the first two axes, X and Y, run along arcs: G17, G2, G3, with I and J.
    pub arcs: bool,
}

/// How axes move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Move {
    /// `G0`.
    Rapid,
    /// At the feed: `G1`, or `G2` and `G3` along an arc.
    Straight,
}

/// How an arc turns, and round what.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgramArc {
    /// 1 counter-clockwise (`G3`), -1 clockwise (`G2`).
    pub turn: f64,
    /// From its start to its centre along the first two axes, mm: I and J.
    pub centre_mm: [f64; 2],
}

/// What one block commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statement<const N: usize> {
    /// Where the axes go, mm or deg, and how; `None` where the block has no word of an axis.
    pub travel: Option<(Move, [Option<f64>; N])>,
    /// The arc along which the first two axes go; `None`: a straight line.
    pub arc: Option<ProgramArc>,
    /// `G93` is in force.
    pub inverse_time: bool,
    /// F of this block; in `G94` that of an earlier one holds.
    pub feed: Option<f64>,
    /// Time of a dwell, s.
    pub dwell_s: Option<f64>,
    /// S of this block.
    pub speed: Option<f64>,
    /// `M3` starts the ram, `M5` stops it.
    pub ram: Option<bool>,
    /// The program ends here.
    pub ends: bool,
}

/// What the blocks so far have set.
#[derive(Debug, Default)]
struct Modes {
    motion: Option<Move>,
    /// Turn of arcs, while G2 or G3 is in force.
    turn: Option<f64>,
    inverse_time: bool,
    feed: Option<f64>,
    /// Which of `G17`, `G21` and `G90` have been given.
    given: Vec<u32>,
}

/// A word of this group rules out another one in the same block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ModalGroup {
    Motion,
    Dwell,
    Units,
    Positions,
    Plane,
    Feed,
    Ram,
    Stop,
    End,
}

/// Takes the statements of a program one after the other; gives the number of its lines, and whether its end was
/// there.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing, and what `take` says against a statement.
pub fn statements<const N: usize>(
    text: &str,
    grammar: &Grammar<N>,
    mut take: impl FnMut(Statement<N>) -> Result<(), String>,
) -> Result<(usize, Result<(), String>), String> {
    let mut modes = Modes::default();
    blocks(text, |words| {
        let statement = modes.statement(words, grammar)?;
        take(statement)?;
        Ok(statement.ends)
    })
}

impl Modes {
    fn statement<const N: usize>(&mut self, words: &[Word], grammar: &Grammar<N>) -> Result<Statement<N>, String> {
        let mut target = [None; N];
        let (mut feed, mut pause, mut speed, mut ram) = (None, None, None, None);
        let (mut dwells, mut ends) = (false, false);
        let mut centre = [None; 2];
        let mut letters = Vec::new();
        let mut groups: Vec<(ModalGroup, &Word)> = Vec::new();
        for (index, word) in words.iter().enumerate() {
            let refuse = |why: &str| Err(format!("word `{}`: {why}", word.text));
            if let Some(group) = word.group(grammar)? {
                if let Some((_, before)) = groups.iter().find(|(of, _)| *of == group) {
                    return refuse(&format!("`{}` is in the same block, and one rules out the other", before.text));
                }
                groups.push((group, word));
                match (word.letter, word.number as u32) {
                    ('G', 0) => (self.motion, self.turn) = (Some(Move::Rapid), None),
                    ('G', 1) => (self.motion, self.turn) = (Some(Move::Straight), None),
                    ('G', code @ (2 | 3)) => {
                        (self.motion, self.turn) = (Some(Move::Straight), Some(f64::from(code) * 2.0 - 5.0));
                    }
                    ('G', 4) => dwells = true,
                    ('G', code @ (17 | 21 | 90)) => self.given.push(code),
                    ('M', 0) => {}
                    // A feed means another thing from here on.
                    ('G', code) => (self.inverse_time, self.feed) = (code == 93, None),
                    (_, 3) => ram = Some(true),
                    (_, 5) => ram = Some(false),
                    _ => ends = true,
                }
                continue;
            }
            if letters.contains(&word.letter) {
                return refuse("this letter is twice in the block");
            }
            letters.push(word.letter);
            match word.letter {
                'N' if index > 0 => return refuse("the number of a block is its first word"),
                'N' if !word.is_code() => return refuse("the number of a block is a whole number from zero on"),
                'N' => {}
                'F' if word.number <= 0.0 => return refuse("a feed must be above zero"),
                'F' => feed = Some(word.rate()?),
                'S' if grammar.ram && word.number <= 0.0 => {
                    return refuse("double strokes per minute must be above zero");
                }
                'S' if grammar.ram => speed = Some(word.rate()?),
                'P' if grammar.ram && word.number == 0.0 => pause = Some((0.0, word.text)),
                'P' if grammar.ram && word.number > 0.0 => pause = Some((word.rate()?, word.text)),
                'P' if grammar.ram => return refuse("a dwell lasts zero seconds or more"),
                'I' if grammar.arcs => centre[0] = Some(word.position(AxisKind::Linear)?),
                'J' if grammar.arcs => centre[1] = Some(word.position(AxisKind::Linear)?),
                letter => match grammar.axes.iter().position(|axis| axis.0 == letter) {
                    Some(axis) => target[axis] = Some(word.position(grammar.axes[axis].1)?),
                    None => return refuse(&format!("this letter is not read; axes are {}", grammar.names)),
                },
            }
        }
        let moves = target.iter().any(Option::is_some);
        let dwell_s = match (dwells, pause) {
            (true, None) => return Err("word `G4`: a dwell needs P, its time in s".to_owned()),
            (true, Some((_, text))) if moves => return Err(format!("word `{text}`: a dwell has no positions")),
            (false, Some((_, text))) => return Err(format!("word `{text}`: P belongs to a dwell (G4)")),
            (_, pause) => pause.map(|(seconds, _)| seconds),
        };
        let travel = if moves { Some((self.motion()?, target)) } else { None };
        let arc = self.arc(moves, centre)?;
        if !self.inverse_time {
            self.feed = feed.or(self.feed);
        }
        let feed = if self.inverse_time { feed } else { self.feed };
        Ok(Statement { travel, arc, inverse_time: self.inverse_time, feed, dwell_s, speed, ram, ends })
    }

    /// The arc of a block that moves axes, where one is in force; it says both words of its centre, and no other block
    /// says any.
    fn arc(&self, moves: bool, centre: [Option<f64>; 2]) -> Result<Option<ProgramArc>, String> {
        match (self.turn.filter(|_| moves), centre) {
            (Some(_), _) if !self.given.contains(&17) => {
                Err("an arc before `G17`: a control takes the plane that was modal before".to_owned())
            }
            (Some(turn), [Some(i), Some(j)]) => Ok(Some(ProgramArc { turn, centre_mm: [i, j] })),
            (Some(_), _) => Err("an arc needs I and J, from its start to its centre".to_owned()),
            (None, [None, None]) => Ok(None),
            (None, _) => Err("I and J belong to an arc (G2, G3)".to_owned()),
        }
    }

    /// How axes move, where all modes that it takes are in force.
    fn motion(&self) -> Result<Move, String> {
        for (code, means) in [(21, "mm"), (90, "absolute positions")] {
            if !self.given.contains(&code) {
                return Err(format!("axes move before `G{code}` ({means}): a control takes what was modal before"));
            }
        }
        self.motion.ok_or_else(|| "axes move, but neither G0 nor G1 has been given".to_owned())
    }
}

impl Word<'_> {
    /// Whether its number is that of a code: whole, and no sign before it.
    fn is_code(&self) -> bool {
        self.number.fract() == 0.0 && self.number.is_sign_positive()
    }

    /// Modal group of a G or M; none of other letters.
    fn group<const N: usize>(&self, grammar: &Grammar<N>) -> Result<Option<ModalGroup>, String> {
        let (ram, arcs) = (grammar.ram, grammar.arcs);
        let code = if self.is_code() { self.number as u32 } else { u32::MAX };
        let refusal = match (self.letter, code) {
            ('G', 0 | 1) => return Ok(Some(ModalGroup::Motion)),
            ('G', 2 | 3) if arcs => return Ok(Some(ModalGroup::Motion)),
            ('G', 4) if ram => return Ok(Some(ModalGroup::Dwell)),
            ('G', 17) if arcs => return Ok(Some(ModalGroup::Plane)),
            ('G', 21) => return Ok(Some(ModalGroup::Units)),
            ('G', 90) => return Ok(Some(ModalGroup::Positions)),
            ('G', 93 | 94) => return Ok(Some(ModalGroup::Feed)),
            ('M', 3 | 5) if ram => return Ok(Some(ModalGroup::Ram)),
            ('M', 0) if arcs => return Ok(Some(ModalGroup::Stop)),
            ('M', 2 | 30) => return Ok(Some(ModalGroup::End)),
            ('G', 20) => "inches are not read; write the program in mm (G21)",
            ('G', 91) => "relative positions are not read; write absolute ones (G90)",
            ('G', 2 | 3) => "arcs are not read; write straight lines (G1)",
            ('G', 84) => "a tapping cycle on most controls, and a one-block gear on one; neither is read",
            ('G', _) if ram => {
                "this G is not read; known are G0, G1, G4, G21, G90, G93, G94; a program for a control is tested as \
                 output.post = \"plain\" writes it"
            }
            ('G', _) => {
                "this G is not read; known are G0, G1, G21, G90, G93, G94; a program for a control is tested as \
                 output.post = \"plain\" writes it"
            }
            ('M', _) if ram => "this M is not read; known are M2, M3, M5, M30",
            ('M', _) => "this M is not read; known are M2, M30",
            _ => return Ok(None),
        };
        Err(format!("word `{}`: {refusal}", self.text))
    }
}
