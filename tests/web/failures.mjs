import { inspect } from 'node:util';

/** A reporter for node's test runner that tells failures, skips and counts: of hundreds of tests few lines are read. */
export default async function* failures(source) {
  for await (const { type, data } of source) {
    if (type === 'test:fail' && data.details.error.failureType !== 'subtestsFailed') {
      const { error } = data.details;
      yield `not ok - ${data.name} (${data.file}, after ${Math.round(data.details.duration_ms)} ms)\n${inspect(error.cause ?? error)}\n`;
    } else if (type === 'test:pass' && data.skip !== undefined) yield `skipped - ${data.name}: ${data.skip}\n`;
    else if (type === 'test:diagnostic' && data.nesting === 0) yield `# ${data.message}\n`;
    else if (type === 'test:stderr' || type === 'test:stdout') yield data.message;
  }
}
