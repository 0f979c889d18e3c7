import {useMemo} from 'preact/hooks';
import type {Console} from '../console';
import {purposesOf} from '../files';
import {t} from '../language';
import {endpointName} from '../names';
import {without} from '../pictures/context';
import {bevelsOf} from '../onward';
import {programmed} from '../pictures/programmed';
import {isSection} from '../pictures/section';
import {away, path, type Reply} from '../service';
import {TabBar} from './controls';
import {Downloads} from './downloads';
import {Exchange} from './exchange';
import {Inspector} from './inspector';
import {MembersTable} from './members';
import {Motion} from './motion';
import {useConsole} from './page';
import {Paper} from './paper';
import {Player} from './player';
import {Charts} from './plots';
import {Columns, Proof} from './proof';
import {Opinion} from './second_opinion';
import {SectionView} from './section';
import {Solid} from './solid';
import {Figures, Table} from './tables';
import {Silence, Verdict} from './verdict';

/** The answer: its verdict, its pictures, and the details under them. */
export function Result() {
  const console = useConsole();
  const {lost, reply, said, trouble, answer} = console;
  return (
    <>
      <Paper />
      <div id="verdict" role="status" aria-live="polite">
        {lost.value !== null ? (
          <Lost why={lost.value()} as={console.lostAs.value} />
        ) : reply.value ? (
          <Verdict
            reply={reply.value}
            focus={(pointer) => console.seek(pointer)}
            again={() => console.compute()}
            facts={said.value}
            seen={(warning) => console.shows(warning)}
            check={() => void console.opinion.ask(reply.value as Reply)}
          />
        ) : (
          <p class="waiting">{t('Waiting for the service …')}</p>
        )}
      </div>
      <p id="trouble" role="alert" hidden={!trouble.value}>
        {trouble.value}
      </p>
      <Opinion />
      <nav id="onward" aria-label={t('Go on to')} hidden={!answer.value}>
        <Onward />
      </nav>
      <Pictures />
      {console.endpoint.value === 'frames' && <MembersTable />}
      <div id="details">{reply.value && <Details />}</div>
    </>
  );
}

/** A link that leads to no job. */
const Lost = ({why, as}: {why: string; as: string}) =>
  as === 'damaged' ? (
    <Silence title={t('This link is damaged.')} detail={t('{why} Request a new link, or choose an endpoint above.', {why})} pill={t('no job')} />
  ) : (
    <Silence title={t('This job is not here.')} detail={why} pill={t('no job')} />
  );

function Onward() {
  const console = useConsole();
  return (
    <>
      <span class="soft">{t('Go on to')}</span>
      {console.leads.value.map(({name, endpoint, body}) => (
        <button type="button" key={name} data-onward={endpoint} onClick={() => void console.follow(endpoint, body)}>
          {name}
        </button>
      ))}
      {console.answer.value?.result['b_sign'] !== 'inward' /* of which a program is refused */ &&
        purposesOf(console.contract.formats(path(console.endpoint.value))).includes('program') && (
          <button type="button" data-onward="program" title={t('The program of a machine, with a preview')} onClick={() => console.files('program')}>
            {t('Program')}
          </button>
        )}
      <button type="button" data-onward="files" onClick={() => console.files()}>
        {t('Files')}
      </button>
    </>
  );
}

function Pictures() {
  const console = useConsole();
  const [drawn, program] = [console.picture.value, console.program.value];
  const picture = useMemo(() => (drawn && program ? programmed(drawn, program) : drawn), [drawn, program]);
  const {solid, charts = [], figures = [], inspected, played, section} = picture ?? {};
  const alone = picture && (!solid || !(charts.length || inspected));
  const ways = {
    open: (endpoint: string, body: Console['body']) => void console.follow(endpoint, body),
    focus: (pointer: string) => console.seek(pointer),
    chose: (item: number | null) => {
      console.item.value = item;
      console.remember();
    },
  };
  return (
    <div id="pictures" class={[alone && 'alone', inspected && 'inspected'].filter(Boolean).join(' ')}>
      <div id="left">
        <Solid
          picture={picture}
          title={endpointName(console.endpoint.value)}
          job={console.job.value}
          view={console.view.value}
          partners={console.partners.value}
          change={(to) => console.change(to)}
          failed={console.failed}
        />
        <div id="player" role="group" aria-label={t('Time')} hidden={!played}>
          {played && <Player given={played} />}
        </div>
        <figure id="section" hidden={!section}>
          {section && <SectionView given={section} />}
        </figure>
        <div id="figures">
          <Figures figures={figures} />
        </div>
      </div>
      <section id="inspector" aria-label={t('Members, joints and parts')} hidden={!inspected}>
        {inspected && <Inspector given={inspected} item={console.item.value} ways={ways} />}
      </section>
      <Charts id="charts" charts={charts} failed={console.failed} warnings={console.answer.value?.warnings} job={console.job.value} />
    </div>
  );
}

/** The details under the pictures. */
function Details() {
  const console = useConsole();
  const offered = console.details;
  const tab = offered.some(([id]) => id === console.tab.value) ? console.tab.value : 'proof';
  return (
    <>
      <TabBar offered={offered.map(([id, name]) => [id, t(name)])} chosen={tab} choose={(id) => console.choose(id)} />
      <div role="tabpanel" id="panel" aria-labelledby={`tab-${tab}`}>
        <Panel tab={tab} />
      </div>
    </>
  );
}

function Panel({tab}: {tab: string}) {
  const console = useConsole();
  const {body, contract, context} = console;
  const [reply, answer, picture, endpoint] = [console.reply.value, console.answer.value, console.picture.value, console.endpoint.value];
  if (tab === 'json') return <Exchange endpoint={endpoint} body={body} reply={reply?.answer ?? reply?.problem} />;
  if (!answer)
    return (
      <p class="soft">{reply?.problem?.code === away.code ? t('Nothing yet: the service did not answer.') : t('Nothing yet: the request was refused.')}</p>
    );
  if (tab === 'table') return <Columns answer={answer} />;
  if (tab === 'downloads')
    return (
      <Downloads
        key={`${endpoint} ${console.wanted.value}`}
        endpoint={endpoint}
        name={console.example.value ?? endpoint}
        body={body}
        formats={contract.formats(path(endpoint))}
        answer={answer}
        program={console.program}
      />
    );
  if (tab === 'motion')
    return (
      <Motion
        cut={without(body)}
        section={isSection(answer) ? bevelsOf(answer.result) : undefined}
        context={context}
        open={(next) => void console.follow('pulse-schedules', next)}
        focus={(pointer) => console.seek(pointer)}
        failed={console.failed}
      />
    );
  return (
    <>
      {picture?.tables && picture.tables.length > 0 && (
        <div class="columns">
          {picture.tables.map((each, i) => (
            <Table key={i} {...each} />
          ))}
        </div>
      )}
      <Proof answer={answer} />
    </>
  );
}
