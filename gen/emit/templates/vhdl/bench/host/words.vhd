{% if part == "procedures" %}
        procedure write_word (address : natural; value : word_t) is
        begin
            transfer(true, address, value);
        end procedure;

        -- Word by word upwards, so that results are of one moment on a bus that can have it.
        procedure read_words (address : natural; count : positive) is
        begin
            for n in 0 to count - 1 loop
                transfer(false, address + n, x"00000000");
                words(n) := answer;
            end loop;
        end procedure;
{% endif %}
