// Reads models outside the page's thread, so that no file blocks it. One order, one answer.
import * as importer from './importer';
import type {Order, Told} from './reading';
import {kinds, text} from './model';

const carriedOut = async ({ending, file, schedules, answers, again}: Order): Promise<Told> => {
  const kind = Object.hasOwn(kinds, ending) ? kinds[ending] : undefined;
  if (!kind) throw new Error(`It is not a model: ${ending}.`);
  if (answers && !again) return {imported: await kind.read(importer, file, answers)};
  return {questions: kind.questions(importer, text(file), schedules, answers)};
};

addEventListener('message', ({data}: MessageEvent<Order>) => {
  carriedOut(data).then(
    (told) => postMessage(told),
    (failure: unknown) => postMessage({failure: failure instanceof Error ? failure.message : String(failure)} satisfies Told),
  );
});
