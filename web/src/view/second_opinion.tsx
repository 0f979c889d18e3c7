import type {Certificate} from '../../../clients/check/src/index';
import {beside, sentence, spelled} from '../words';
import {useConsole} from './page';
import {Sheet} from './tables';

/** In as many digits as tell a residual from its bound. */
const figure = (value: number, unit: string) => beside(Number.isInteger(value) ? String(value) : value.toPrecision(2), spelled(unit));

const note = 'Recomputed in this browser by another program, from the answer as the service sent it.';

function Certified({certificate: {checks, notChecked, passed}}: {certificate: Certificate}) {
  const failed = checks.filter((check) => !check.passed).length;
  return (
    <>
      <p data-passed={passed}>
        <b>{passed ? `All ${checks.length} independent checks hold.` : `${failed} of ${checks.length} independent checks fail.`}</b>
      </p>
      <Sheet title="Independent checks" head={['Check', '', 'Found', 'At most', 'Places', '']} note={note} whole>
        {checks.map(({name, value, limit, unit, places, passed: held, where}) => (
          <tr key={name} class={held ? '' : 'failed'}>
            <td>{sentence(name.replace(/_/g, ' '))}</td>
            <td>{held ? 'ok' : 'FAILED'}</td>
            <td>{figure(value, unit)}</td>
            <td>{figure(limit, unit)}</td>
            <td>{places}</td>
            <td>{where}</td>
          </tr>
        ))}
        {notChecked.map(({pointer, why}) => (
          <tr key={pointer}>
            <td>{pointer}</td>
            <td>not checked</td>
            <td colSpan={4}>{why}</td>
          </tr>
        ))}
      </Sheet>
    </>
  );
}

/** The certificate of the shown answer, if one was asked for. */
export function Opinion() {
  const {opinion, reply} = useConsole();
  const shown = opinion.shown.value;
  if (!shown || shown.of !== reply.value) return null;
  const {told} = shown;
  return (
    <section id="opinion" aria-label="Independent checks">
      <button type="button" class="right" onClick={() => opinion.close()}>
        Close
      </button>
      <div role="status">
        {!told ? <p>Checking …</p> : 'failure' in told ? <p>The independent checker failed: {told.failure}</p> : <Certified certificate={told.certificate} />}
      </div>
    </section>
  );
}
