import {Console} from './console';
import {byId} from './dom';
import type {Row} from './json';
import {askForKey, KeyNeeded} from './key';
import * as panels from './panels';
import {Contract} from './schema';
import {fetched, type Endpoint, type Example} from './service';
import {themed} from './theme';

async function begin(started: (page: Console) => void): Promise<void> {
  try {
    const [contract, examples, version, machines, tubes] = await Promise.all([
      fetched<ConstructorParameters<typeof Contract>[0]>('/openapi.json'),
      fetched<{examples: Example[]}>('/v1/examples'),
      fetched<{endpoints: Endpoint[]}>('/v1/version'),
      fetched<{machines: {name: string; machine: Row}[]}>('/v1/machines'),
      fetched<{tubes: {size: string; outer_diameter_mm: number; wall_mm: number}[]}>('/v1/tubes'),
    ]);
    const page = new Console(new Contract(contract), examples.examples, version.endpoints, machines.machines, tubes.tubes);
    started(page);
    await page.arrive(location.hash);
  } catch (failure) {
    if (failure instanceof KeyNeeded) return askForKey(byId('verdict'), () => void begin(started));
    const why = failure instanceof Error ? failure.message : String(failure);
    panels.silence(byId('verdict'), 'The console could not start.', why, () => void begin(started));
  }
}

let open: Console | undefined;
themed(() => open?.recolour());
void begin((page) => {
  open = page;
});
