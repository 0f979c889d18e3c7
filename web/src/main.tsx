import {render} from 'preact';
import {Console} from './console';
import {byId} from './dom';
import {KeyNeeded, tried} from './key';
import {speak, t, wanted} from './language';
import {Contract} from './schema';
import {Away, fetched, type Endpoint, type Example, type Machine, type Tube} from './service';
import {Shell} from './view/shell';
import {Unlock} from './view/unlock';
import {Silence} from './view/verdict';
import {Watch} from './watch';

const root = byId('page');
const watch = new Watch();

async function begin(): Promise<void> {
  try {
    const [contract, examples, version, machines, tubes] = await Promise.all([
      fetched<ConstructorParameters<typeof Contract>[0]>('/openapi.json'),
      fetched<{examples: Example[]}>('/v1/examples'),
      fetched<{endpoints: Endpoint[]}>('/v1/version'),
      fetched<{machines: Machine[]}>('/v1/machines'),
      fetched<{tubes: Tube[]; rectangular_tubes: {size: string}[]}>('/v1/tubes'),
    ]);
    const page = new Console(new Contract(contract), examples.examples, version.endpoints, machines.machines, tubes);
    render(<Shell console={page} />, root);
    await page.arrive(location.hash);
  } catch (failure) {
    const again = () => {
      watch.end();
      void begin();
    };
    if (failure instanceof Away) watch.begin(again);
    const why = failure instanceof Error ? failure.message : String(failure);
    render(
      <Shell>
        {failure instanceof KeyNeeded ? <Unlock key={tried()} go={again} /> : <Silence title={t('The console could not start.')} detail={why} again={again} />}
      </Shell>,
      root,
    );
  }
}

/** Without its Chinese texts the page is English. */
async function open(): Promise<void> {
  await speak(wanted()).catch(() => {});
  root.replaceChildren(); // placeholders until this was loaded
  render(
    <Shell>
      <p class="waiting">{t('Waiting for the service …')}</p>
    </Shell>,
    root,
  );
  await begin();
}
void open();
