import SwaggerUI from 'swagger-ui-dist/swagger-ui-es-bundle.js';
import type {Example} from '../src/service';

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

const load = async <T>(address: string): Promise<T> => (await (await fetch(address)).json()) as T;

/** The contract, with every example of the service as one that can be run against this very service. */
async function begin(): Promise<void> {
  const [contract, listed] = await Promise.all([load<Document>('/openapi.json'), load<{examples: Example[]}>('/v1/examples')]);
  contract.servers = [{url: location.origin, description: 'this service'}];
  for (const {endpoint, name, body} of listed.examples) {
    const content = contract.paths[`/v1/${endpoint}`]?.['post']?.requestBody?.content['application/json'];
    if (content) content.examples = {...content.examples, [name]: {value: body}};
  }
  // Swagger UI would send every default, and options of a drawing are refused beside JSON.
  for (const parameter of Object.values(contract.components.parameters)) {
    if (parameter.schema.default === undefined) continue;
    parameter.description = `${parameter.description ?? ''} Default: ${String(parameter.schema.default)}.`;
    delete parameter.schema.default;
  }
  SwaggerUI({
    spec: contract,
    dom_id: '#reference',
    deepLinking: true,
    tryItOutEnabled: true,
    defaultModelsExpandDepth: 0,
    validatorUrl: null,
    syntaxHighlight: {activated: false},
    docExpansion: 'list',
  });
}

void begin();
