// Checks an answer outside the page's thread: a large frame takes minutes.
import {certify} from '../../clients/check/src/index';
import type {Order, Told} from './second_opinion';

addEventListener('message', ({data: {answer, request, names}}: MessageEvent<Order>) => {
  let told: Told;
  try {
    told = {certificate: certify(answer, request, names)};
  } catch (failure) {
    told = {failure: failure instanceof Error ? failure.message : String(failure)};
  }
  postMessage(told);
});
