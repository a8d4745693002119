import { say } from '../../base/texts.js';
import { each, foldable } from '../section.js';
import { connectionSections } from './connection-sections.js';
import { sceneSections } from './scene-sections.js';

/** @import { Page } from '../section.js' */

/** What is set before a presentation rather than in it. @param {Page} page */
export function settings(page) {
  const sections = [...sceneSections(page), ...connectionSections(page)];
  return {
    title: say('settings.title'),
    content: sections.map(foldable),
    show: each(...sections.map(({ show }) => show)),
  };
}
