import { added, deletionOf, isNone, restorationOf } from '../../base/added.js';
import { button, element } from '../../base/element.js';
import { onChange } from '../../base/store.js';
import { listed, say } from '../../base/texts.js';
import { stateOf } from '../section.js';

/**
 * @import { Added } from '../../base/added.js'
 * @import { Page } from '../section.js'
 */

/** Asks before what people have added to the scene is deleted. @param {Page} page */
export function deletion({ commands, store, offer }) {
  let all = added(stateOf(store));
  const question = element('p');
  const close = () => /** @type {HTMLDialogElement} */ (question.closest('dialog')).close();
  const remove = async () => {
    const counted = all;
    close();
    if (!await commands.patch(deletionOf(counted))) return;
    offer(say('deletion.done'), say('views.undo'), () => commands.patch(restorationOf(counted, stateOf(store))));
  };
  return {
    title: say('deletion.title'),
    content: [question, element('div', { className: 'buttons' },
      button(say('deletion.delete'), remove, { icon: 'remove' }), button(say('deletion.keep'), close))],
    show: onChange(({ state }) => [state.cues, state.markers, state.measures, state.views], () => {
      all = added(stateOf(store));
      question.textContent = say('deletion.question', { what: countWords(all) });
      if (isNone(all)) close();
    }),
  };
}

/** How many there are of each, in words. @param {Added} all */
export function countWords({ cues, markers, measures, views }) {
  const count = (entries) => Object.keys(entries).length;
  const words = [
    count(cues) > 0 && say('deletion.cues', { count: count(cues) }),
    count(markers) > 0 && say('deletion.notes', { count: count(markers) }),
    count(measures) > 0 && say('deletion.measures', { count: count(measures) }),
    count(views) > 0 && say('deletion.views', { count: count(views) }),
  ];
  return listed(words.filter((word) => word !== false));
}
