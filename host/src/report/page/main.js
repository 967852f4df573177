// The page: notices, what was run, frames, plots, tables.

function sectionOf(heading, nodes, classes = 'grid') {
  const there = nodes.filter(Boolean);
  return there.length ? [element('h2', {}, heading), element('div', { class: classes }, there)] : [];
}

// Plots of one name stand beside each other, in the order in which they first appear, under the headings of their groups.
function plotSections(runs, views) {
  const rows = new Map();
  runs.forEach((run, at) => {
    for (const view of views[at]) {
      const { id, group } = view.plot;
      if (!rows.has(id)) rows.set(id, { group, views: runs.map(() => null) });
      rows.get(id).views[at] = view;
    }
  });
  const groups = new Map();
  for (const row of rows.values()) {
    if (!groups.has(row.group)) groups.set(row.group, []);
    const absent = () => element('section', { class: 'card absent' }, 'this run has no such plot');
    groups.get(row.group).push(...row.views.map((view) => (view ? view.node : absent())));
  }
  return { rows: [...rows.values()], nodes: [...groups].flatMap(([group, nodes]) => sectionOf(group, nodes)) };
}

function drawRows(rows) {
  for (const { views } of rows) {
    const there = views.filter(Boolean);
    const ranges = there.map((view) => view.range()).filter(({ xs, ys }) => xs && ys);
    if (!ranges.length) {
      for (const view of there) view.svg.replaceWith(element('p', { class: 'reading' }, 'There are no values to draw.'));
      continue;
    }
    const xs = extent(ranges.flatMap((range) => range.xs));
    const ys = extent(ranges.flatMap((range) => range.ys));
    for (const view of there) view.draw(xs, ys);
  }
}

function build() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const { runs } = data;
  const page = document.getElementById('page');
  const isSeveral = runs.length > 1;
  page.classList.toggle('beside', isSeveral);
  page.style.setProperty('--runs', Math.min(runs.length, 3));
  document.title = `Sinew report: ${runs.map((run) => run.name).join(', ')}`;
  const tables = runs.map((run) => new Map(run.tables.map((table) => [table.name, new TableData(table)])));
  const players = runs.map((run, at) => (run.player && run.player.frames.length ? new PlayerView(run.player, tables[at]) : null));
  const shown = players.filter(Boolean);
  let transport = null;
  const views = runs.map((run, at) => {
    run.beside = isSeveral;
    const onFrame = (frame) => {
      const index = players[at] ? players[at].player.frames.indexOf(frame) : -1;
      if (index >= 0) transport.goToFrame(shown.indexOf(players[at]), index);
    };
    const isBars = (plot) => plot.series.some((series) => series.style === 'bars');
    return run.plots.map((plot) => (isBars(plot) ? new BarsView(plot, run, tables[at]) : new PlotView(plot, run, tables[at], onFrame)));
  });
  const notices = runs.flatMap((run) => run.notices.map((notice) => noticeView(notice, run, isSeveral)));
  const plots = plotSections(runs, views);
  const playerCards = players.map((player, at) => {
    if (!player) return isSeveral ? element('section', { class: 'card absent' }, 'this run has no frames') : null;
    return element('section', { class: 'card' }, isSeveral ? element('h3', { class: 'run-name' }, runs[at].name) : null, player.node);
  });
  const hint = players.some(Boolean) ? 'Keys: arrows step a frame (with shift ten), space plays, Home and End jump. A click in a plot goes to its frame.' : '';
  page.append(
    element('header', {}, element('h1', {}, 'Sinew report'), element('p', {}, hint), themeButton()),
    ...notices,
    ...sectionOf('What was run', runs.map(runCard)),
    ...(players.some(Boolean) ? sectionOf('Frames', playerCards) : []),
    ...plots.nodes,
    ...sectionOf('Pictures', runs.flatMap((run) => run.pictures.map((picture) => stillView(picture, run)))),
    ...runs.flatMap((run, at) => sectionOf(isSeveral ? `Tables of ${run.name}` : 'Tables', [...tables[at].values()].map(tableView), 'tables')),
    element('footer', {}, `Made by sinew ${data.sinew_version}. The page is one file and loads nothing.`),
  );
  drawRows(plots.rows);
  if (shown.length) {
    transport = new Transport(shown, () => {
      players.forEach((player, at) => {
        if (!player) return;
        for (const view of views[at]) view.showFrame(player.frame);
      });
    });
    page.append(transport.node);
    transport.go(0);
  }
  let width = page.clientWidth;
  new ResizeObserver(() => {
    if (page.clientWidth === width) return;
    width = page.clientWidth;
    drawRows(plots.rows);
  }).observe(page);
}

build();
