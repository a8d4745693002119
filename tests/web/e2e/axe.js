import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** Checks that axe finds nothing on a page. */
export async function assertClean(page) {
  const { passes, violations: found } = await page.evaluate(async (source) => {
    if (!window.axe) (0, eval)(source);
    // What fades is looked at when it has.
    await Promise.allSettled(document.getAnimations().map((animation) => animation.finished));
    const { violations, passes } = await window.axe.run(document, { resultTypes: ['violations'] });
    return { passes: passes.length, violations: violations.map(({ id, help, nodes }) => ({ id, help, nodes: nodes.map(({ html, failureSummary }) => [html, failureSummary]) })) };
  }, axe);
  assert.deepEqual(found, []);
  assert.ok(passes > 10, `${passes} rules passed`);
}
