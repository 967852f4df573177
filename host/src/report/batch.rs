//! Pages of batches and sweeps: what became of each recording, and its numbers.

use super::document::{Colour, Fact, Level, Plot, Run, Series, Style};
use super::folder::RunFolder;
use super::series::{only, select};
use super::table::Table;
use std::cmp::Ordering;

/// Most recordings of a sweep that get a line each; beyond, colours repeat.
const MAX_LINES: usize = 7;

/// Numbers that are drawn rather than the first that varies.
const MAIN: [&str; 3] = ["error_m", "joint_error_m", "cadence_per_min"];

/// The batch in `folder`.
pub fn batch_run(mut folder: RunFolder) -> Run {
    let mut run = Run { name: folder.path().display().to_string(), ..Run::default() };
    let is_sweep = folder.has("sweep.csv");
    run.kind = if is_sweep { "Sweep" } else { "Batch" }.to_owned();
    let status = folder.table("status.csv", "How each recording ended");
    if let Some(status) = &status {
        let of = |word: &str| status.rows.iter().filter(|row| status.cell(row, "status") == word).collect::<Vec<_>>();
        let counts = [("With a result", of("ok")), ("Failed", of("error")), ("Open", of("open"))];
        run.highlights.push(Fact::new("Recordings", status.rows.len().to_string()));
        run.highlights.extend(counts.map(|(label, rows)| Fact::new(label, rows.len().to_string())));
        let failed = of("error").into_iter();
        let reasons =
            failed.map(|row| format!("{}: {}", status.cell(row, "id"), status.cell(row, "message"))).collect();
        folder.notice_of(Level::Missing, "these recordings have no result", reasons);
    }
    if is_sweep && let Some(mut table) = folder.table("sweep.csv", "Parameters and numbers of each recording") {
        let parameters = parameters(&table);
        sort(&mut table, &parameters);
        run.plots = parameters.iter().filter_map(|parameter| plot(&table, parameter)).collect();
        run.tables.push(table);
    } else if !is_sweep {
        run.tables.extend(folder.table("summary.csv", "Numbers of each recording"));
    }
    run.tables.extend(status);
    run.notices = folder.into_notices();
    run
}

/// The columns between a sweep's input and status.
fn parameters(table: &Table) -> Vec<String> {
    let first = table.column("input").map_or(0, |column| column + 1);
    let last = table.column("status").unwrap_or(first).max(first);
    table.columns[first..last].to_vec()
}

/// Sorts the rows by their parameters, then by their names.
fn sort(table: &mut Table, parameters: &[String]) {
    let columns: Vec<usize> = parameters.iter().filter_map(|name| table.column(name)).chain([0]).collect();
    let compare = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => a.total_cmp(&b),
        _ => a.cmp(b),
    };
    table.rows.sort_by(|a, b| {
        let each = columns.iter().map(|column| compare(&a[*column], &b[*column]));
        each.fold(Ordering::Equal, Ordering::then)
    });
}

/// The main number against a parameter that has several, a colour an input.
fn plot(table: &Table, parameter: &str) -> Option<Plot> {
    let is_number = |cell: &String| cell.parse::<f64>().is_ok();
    let values = table.distinct(parameter);
    if values.len() < 2 || !values.iter().all(is_number) {
        return None;
    }
    let numbers = || table.columns.iter().skip_while(|name| *name != "status").skip(1);
    let varies = |name: &&String| table.distinct(name).iter().filter(|cell| is_number(cell)).count() > 1;
    let main = MAIN.iter().find_map(|main| numbers().find(|name| name == main)).filter(varies);
    let number = main.or_else(|| numbers().find(varies))?;
    let of_input = |(index, input): (usize, &String)| Series {
        name: input.clone(),
        only: only("input", input),
        style: Style::Dots,
        colour: Colour::nth(index),
        ..select(table, parameter, number)
    };
    let inputs = table.distinct("input");
    Some(Plot {
        id: format!("sweep {parameter}"),
        group: "Against parameters".to_owned(),
        title: format!("{number} against {parameter}"),
        reading:
            "A point a combination, a colour a recording: what does not change with a parameter does not depend on it."
                .to_owned(),
        x_label: parameter.to_owned(),
        y_label: number.clone(),
        pairs: true,
        series: inputs.iter().enumerate().take(MAX_LINES).map(of_input).collect(),
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const STATUS: &str =
        "id,key,status,class,message,seconds,attempts\na,k,ok,,,0.1,1\nb,l,error,data,no table,0.1,1\n";

    #[test]
    fn a_batch_shows_its_summary_and_what_failed() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("status.csv"), STATUS).unwrap();
        fs::write(folder.path().join("summary.csv"), "id,cadence_per_min\na,55.5\n").unwrap();
        let run = batch_run(RunFolder::new(folder.path()));
        assert_eq!((run.kind.as_str(), run.tables.len(), run.plots.len()), ("Batch", 2, 0));
        assert_eq!(run.notices[0].items, ["b: no table"]);
        let counts: Vec<&str> = run.highlights.iter().map(|fact| fact.value.as_str()).collect();
        assert_eq!(counts, ["2", "1", "1", "0"]);
    }

    #[test]
    fn a_sweep_is_sorted_by_its_parameters_and_drawn_against_them() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("status.csv"), STATUS).unwrap();
        let rows =
            "id,input,particles,model,status,note,error_m\nw.10,w,10,x,ok,,0.1\nw.9,w,9,x,ok,,0.2\nv.9,v,9,x,error,,\n";
        fs::write(folder.path().join("sweep.csv"), rows).unwrap();
        let run = batch_run(RunFolder::new(folder.path()));
        let ids: Vec<&str> = run.tables[0].rows.iter().map(|row| row[0].as_str()).collect();
        assert_eq!(ids, ["v.9", "w.9", "w.10"]);
        assert_eq!((run.plots.len(), run.plots[0].y_label.as_str()), (1, "error_m"));
        assert_eq!((run.plots[0].x_label.as_str(), run.plots[0].series.len()), ("particles", 2));
    }
}
