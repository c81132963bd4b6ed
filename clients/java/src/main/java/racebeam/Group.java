package racebeam;

import java.util.List;
import java.util.Map;
import java.util.NoSuchElementException;

/**
 * A group of a reply: its pairs of key and value.
 *
 * @param texts the values that are not bytes, in the order of the reply
 * @param bytes the decoded fields that are bytes, such as screen and ram
 */
public record Group(Map<String, String> texts, Map<String, byte[]> bytes) {
  /**
   * Returns whether the group has a key. Some keys, such as {@code over}, are not always there.
   *
   * @param key the key
   * @return whether the group has it
   */
  public boolean has(String key) {
    return texts.containsKey(key) || bytes.containsKey(key);
  }

  /**
   * Returns a value as it was sent.
   *
   * @param key the key
   * @return its value
   * @throws NoSuchElementException if the group does not have it
   */
  public String text(String key) {
    return found(texts.get(key), key);
  }

  /**
   * Returns a value as a whole number.
   *
   * @param key the key
   * @return its value
   * @throws NoSuchElementException if the group does not have it
   * @throws NumberFormatException if it is another text
   */
  public long number(String key) {
    return Long.parseLong(text(key));
  }

  /**
   * Returns a value as a number that may have a fraction, such as the setting sticky.
   *
   * @param key the key
   * @return its value
   * @throws NoSuchElementException if the group does not have it
   * @throws NumberFormatException if it is another text
   */
  public double real(String key) {
    return Double.parseDouble(text(key));
  }

  /**
   * Returns a list, whose elements commas separate in the reply.
   *
   * @param key the key
   * @return its elements
   * @throws NoSuchElementException if the group does not have it
   */
  public List<String> list(String key) {
    String text = text(key);
    return text.isEmpty() ? List.of() : List.of(text.split(","));
  }

  /**
   * Returns a field that consists of bytes. The array belongs to the caller.
   *
   * @param field the field
   * @return its bytes
   * @throws NoSuchElementException if the group does not have it, or it is not a field of bytes
   */
  public byte[] bytes(String field) {
    return found(bytes.get(field), field);
  }

  /**
   * Returns the field reward.
   *
   * @return the sum of the request's rewards
   * @throws NoSuchElementException if it was not observed
   */
  public long reward() {
    return number("reward");
  }

  /**
   * Returns the field lives.
   *
   * @return the remaining lives
   * @throws NoSuchElementException if it was not observed
   */
  public int lives() {
    return (int) number("lives");
  }

  /**
   * Returns whether the field terminated or truncated is 1.
   *
   * @return whether the episode has ended
   * @throws NoSuchElementException if one of them was not observed
   */
  public boolean isOver() {
    return number("terminated") == 1 || number("truncated") == 1;
  }

  private <T> T found(T value, String key) {
    if (value == null) {
      throw new NoSuchElementException("the reply has no '" + key + "'; it has " + texts.keySet() + " and " + bytes.keySet());
    }
    return value;
  }
}
