// What is used of it. Its published types bring those of node with them, which are wrong in a browser.
declare module 'papaparse' {
  interface Result<T> {
    data: T[];
    errors: {type: string; message: string; row?: number}[];
  }
  const Papa: {parse<T>(text: string, options: {skipEmptyLines?: boolean | 'greedy'; delimiter?: string}): Result<T>};
  export default Papa;
}
