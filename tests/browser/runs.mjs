// Small run directories of every kind.
import { execFileSync } from 'node:child_process';
import { cpSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const ANGLES = ['neck', 'l_shoulder', 'l_elbow', 'l_wrist', 'r_shoulder', 'r_elbow', 'r_wrist', 'l_hip', 'l_knee', 'l_ankle', 'r_hip', 'r_knee', 'r_ankle'];
// Middle, swing and delay of each angle, as far as a stick figure needs to look as if it walked.
const WALK = [
  [-1.49, 0.02, 0], [-1.38, 0.05, 0], [1.7, 0.35, 0.5], [1.5, 0.45, 0.5], [-2.2, 0.05, 0], [1.7, 0.35, 0], [1.5, 0.45, 0],
  [1.1, 0.05, 0], [1.4, 0.4, 0], [1.8, 0.45, 0.15], [1.3, 0.05, 0], [1.4, 0.4, 0.5], [1.8, 0.45, 0.65],
];

function walkTable(path) {
  const lines = [['frame', ...ANGLES.map((name) => `${name}_rad`)].join(',')];
  for (let frame = 0; frame < 240; frame += 1) {
    const angles = WALK.map(([middle, swing, delay]) => (middle - swing * Math.cos(2 * Math.PI * (frame / 65 - delay))).toFixed(5));
    lines.push([frame, ...angles].join(','));
  }
  writeFileSync(path, `${lines.join('\n')}\n`);
}

// Makes all runs inside `folder`; gives the directory of each.
export function makeRuns(sinew, folder) {
  const run = (...args) => execFileSync(sinew, args, { stdio: ['ignore', 'ignore', 'inherit'] });
  const at = (name) => join(folder, name);
  run('demo', '--out', at('demo'));
  run('demo', '--seed', '2', '--out', at('other'));
  walkTable(at('walk.csv'));
  run('track', 'cyclic', at('walk.csv'), '--model', 'walking', '--rate', '60', '--out', at('estimate.csv'), '--report', at('walk'));
  run('simulate', 'arm', '--motion', 'builtin', '--frames', '30', '--out', at('frames'));
  for (const [name, rate] of [['slow', '15'], ['fast', '30']]) {
    run('track', 'arm', join(at('frames'), 'frames'), '--config', join(at('frames'), 'camera.toml'), '--rate', rate, '--overlay', '--out', at(name));
  }
  run('simulate', 'stereo', '--motion', 'stick-wave', '--points', '300', '--out', at('scene'));
  run('track', 'body', at('scene'), '--particles', '20', '--pictures', '--out', at('body'));
  run('evaluate', 'arm', '--clips', '1', '--seeds', '1', '--frames', '110', '--particles', '10,20', '--variants', 'pik,bootstrap', '--out', at('arms'));
  run('evaluate', 'body', '--motion', 'stick-wave', '--models', 'guided,angular', '--particles', '10,20', '--trials', '1', '--out', at('bodies'));
  cpSync(at('demo'), at('broken'), { recursive: true });
  rmSync(join(at('broken'), 'track.csv'));
  writeFileSync(join(at('broken'), 'run.json'), '{"version": 1, "seed"');
  const names = ['demo', 'other', 'slow', 'fast', 'walk', 'body', 'arms', 'bodies', 'broken'];
  return Object.fromEntries(names.map((name) => [name, at(name)]));
}
