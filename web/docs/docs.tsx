import {render} from 'preact';
import SwaggerUI from 'swagger-ui-dist/swagger-ui-es-bundle.js';
import {save} from '../src/dom';
import {headed, keyed, KeyNeeded, tried} from '../src/key';
import {fetched, type Example} from '../src/service';
import {ThemeButton} from '../src/view/theme';
import {Unlock} from '../src/view/unlock';

interface Operation {
  requestBody?: {content: Record<string, {examples?: Record<string, {value: unknown}>}>};
}
interface Parameter {
  description?: string;
  schema: {default?: unknown};
}
interface Document {
  components: {parameters: Record<string, Parameter>};
  servers: {url: string; description: string}[];
  paths: Record<string, Record<string, Operation>>;
}

interface Sent {
  url: string;
  headers: Record<string, string>;
}
const sent = (request: Sent) => (request.url.startsWith(`${location.origin}/`) ? {...request, headers: headed(request.headers)} : request);

/** The contract, with every example of the service as one that can be run against this very service. */
async function begin(): Promise<void> {
  const [contract, listed] = await Promise.all([fetched<Document>('/openapi.json'), fetched<{examples: Example[]}>('/v1/examples')]);
  contract.servers = [{url: location.origin, description: 'this service'}];
  for (const {endpoint, name, body} of listed.examples) {
    const content = contract.paths[`/v1/${endpoint}`]?.['post']?.requestBody?.content['application/json'];
    if (content) content.examples = {...content.examples, [name]: {value: body}};
  }
  // Swagger UI would send every default, and options of a drawing are refused for JSON.
  for (const parameter of Object.values(contract.components.parameters)) {
    if (parameter.schema.default === undefined) continue;
    parameter.description = `${parameter.description ?? ''} Default: ${String(parameter.schema.default)}.`;
    delete parameter.schema.default;
  }
  render(null, root);
  SwaggerUI({
    spec: contract,
    dom_id: '#reference',
    deepLinking: true,
    tryItOutEnabled: true,
    defaultModelsExpandDepth: 0,
    validatorUrl: null,
    syntaxHighlight: {activated: false},
    docExpansion: 'list',
    requestInterceptor: sent,
    showMutatedRequest: false, // the curl shown with an answer contains no key
  });
}

const root = document.getElementById('reference') as HTMLElement;
function start(): void {
  begin().catch((failure: unknown) => {
    const why = failure instanceof Error ? failure.message : String(failure);
    render(failure instanceof KeyNeeded ? <Unlock key={tried()} go={start} /> : <p class="failure">The reference could not be loaded: {why}</p>, root);
  });
}

/** A link cannot carry the key. */
for (const link of document.querySelectorAll<HTMLAnchorElement>('a[href^="/openapi"]')) {
  link.addEventListener('click', async (event) => {
    if (!keyed()) return;
    event.preventDefault();
    const reply = await fetch(link.href, {headers: headed()});
    if (reply.ok) save(link.pathname.slice(1), await reply.blob());
  });
}

render(<ThemeButton />, document.getElementById('tools') as HTMLElement);
start();
