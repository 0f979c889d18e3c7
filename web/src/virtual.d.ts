declare module 'virtual:words' {
  const words: import('../glossary/words').Words;
  export default words;
}
