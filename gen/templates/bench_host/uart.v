    // Host: bytes out, bytes in.
    localparam real UART_BIT_NS = {{ uart_bit_ns }};
    reg uart_to_card;
    wire uart_from_card;
    reg [7:0] inbox [0:1023];
    integer received;
    reg [7:0] shift;
    integer bit_number;

    task host_idle;
        begin
            uart_to_card = 1'b1;
            received = 0;
        end
    endtask

    always @(negedge uart_from_card) begin
        #(UART_BIT_NS / 2.0);
        for (bit_number = 0; bit_number < 8; bit_number = bit_number + 1) begin
            #(UART_BIT_NS);
            shift = {uart_from_card, shift[7:1]};
        end
        #(UART_BIT_NS);
        if (uart_from_card !== 1'b1)
            complain("stop bit of the UART", {47'd0, uart_from_card}, 48'd1);
        inbox[received[9:0]] = shift;
        received = received + 1;
    end

    task send_byte(input [7:0] value);
        integer k;
        begin
            uart_to_card = 1'b0;
            #(UART_BIT_NS);
            for (k = 0; k < 8; k = k + 1) begin
                uart_to_card = value[k];
                #(UART_BIT_NS);
            end
            uart_to_card = 1'b1;
            #(UART_BIT_NS);
        end
    endtask

    task send_command(input [7:0] command, input integer words, input [31:0] address);
        begin
            send_byte(command);
            send_byte(words[7:0]);
            send_byte(address[31:24]);
            send_byte(address[23:16]);
            send_byte(address[15:8]);
            send_byte(address[7:0]);
        end
    endtask

    task bus_write;
        begin
            send_command(8'h01, 1, access_address);
            send_byte(access_value[31:24]);
            send_byte(access_value[23:16]);
            send_byte(access_value[15:8]);
            send_byte(access_value[7:0]);
        end
    endtask

    // Reads into the inbox; the answer has to come within twice its length on the line.
    task bus_read;
        integer k;
        begin
            received = 0;
            send_command(8'h02, access_words, access_address);
            for (k = 0; k < 80 * access_words + 400 && received < 4 * access_words; k = k + 1)
                #(UART_BIT_NS);
            if (received < 4 * access_words)
                complain("bytes of a UART answer", received, 4 * access_words);
        end
    endtask

{% if pushes %}
    // A card that pushes frames from the start: the one under way goes out, and one byte stands in front of the next answer.
    task stop_pushing;
        begin
            write_word(CARD_STREAM_CONTROL, 32'd0);
            #(UART_BIT_NS * {{ frame_bits }});
            read_words(CARD_ID, 1);
            #(UART_BIT_NS * 12.0);
            if (received != 5 || inbox[0] !== 8'hFF)
                complain("byte in front of the first answer", inbox[0], 48'hFF);
        end
    endtask

{% endif %}
    function [31:0] word(input integer index);
        word = {inbox[4 * index], inbox[4 * index + 1], inbox[4 * index + 2], inbox[4 * index + 3]};
    endfunction
