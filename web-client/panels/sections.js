import { connectionSection } from './connection-section.js';
import { partsSection } from './parts-section.js';
import { sceneSections } from './scene-sections.js';
import { viewsSection } from './views-section.js';

/** @import { Page, Section } from './section.js' */

/**
 * All of the menu, from top to bottom.
 *
 * @param {Page} page
 * @returns {Section[]}
 */
export function sections(page) {
  return [...sceneSections(page), partsSection(page), viewsSection(page), connectionSection(page)];
}
