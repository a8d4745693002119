import { spawn } from 'node:child_process';

/** An X server of its own for VTK, which draws in software. @returns {Promise<{process: ChildProcess, name: string}>} */
export async function startDisplay() {
  const started = spawn('Xvfb', ['-displayfd', '1', '-screen', '0', '1920x1080x24', '-nolisten', 'tcp'], { stdio: ['ignore', 'pipe', 'ignore'] });
  const name = await new Promise((resolve, reject) => {
    started.stdout.once('data', (number) => resolve(`:${String(number).trim()}`));
    started.once('error', reject);
    started.once('exit', () => reject(new Error('Xvfb does not start')));
  });
  return { process: started, name };
}
